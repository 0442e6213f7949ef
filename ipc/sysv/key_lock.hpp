// One gateway a key: System V queues themselves cannot say whether their maker still lives.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "ipc/runtime/lock_file.hpp"
#include "ipc/sysv/key_semaphore.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

// The right to a System V key in this IPC namespace, among the gateways of this user; other users are kept off by the
// owner of the queue. Two things together: a lock file, which can name the holder, and a semaphore, which reaches as
// far as the queue does. Held for life, ends with the process. Moved, not copied.
class KeyLock {
 public:
  // Refused where another process holds it; the message names that process and its instance.
  static Result<KeyLock> take(std::int32_t key, const std::string& instance);

  // Takes a removed lock again (log-out); fails if another gateway was faster.
  [[nodiscard]] Result<void> confirm();
  void release() {
    semaphore_.release();
    file_.release();
  }
  [[nodiscard]] std::int32_t key() const { return key_; }

  // Whether any process holds the key, as far as visible to this user.
  [[nodiscard]] static bool is_held(std::int32_t key);

 private:
  KeyLock(LockFile file, KeySemaphore semaphore, std::int32_t key, std::string instance)
      : file_(std::move(file)), semaphore_(std::move(semaphore)), key_(key), instance_(std::move(instance)) {}
  LockFile file_;
  KeySemaphore semaphore_;
  std::int32_t key_ = 0;
  std::string instance_;
};

// "0x92f (2351)"
[[nodiscard]] std::string key_text(std::int32_t key);

}  // namespace cellmirror
