// One gateway a key: System V queues themselves cannot say whether their maker still lives.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "ipc/runtime/lock_file.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

// The right to a System V key in this IPC namespace, among the gateways of this user; other users are kept off by the
// owner of the queue. Held for life, ends with the process. Moved, not copied.
class KeyLock {
 public:
  // Refused where another process holds it; the message names that process and its instance.
  static Result<KeyLock> take(std::int32_t key, const std::string& instance);

  // Takes the lock anew where its file was removed under it (log-out); fails where another gateway was faster.
  [[nodiscard]] Result<void> confirm();
  void release() { file_.release(); }
  [[nodiscard]] std::int32_t key() const { return key_; }

  // Whether any process of this user holds the key.
  [[nodiscard]] static bool held_by_anybody(std::int32_t key);

 private:
  KeyLock(LockFile file, std::int32_t key, std::string instance)
      : file_(std::move(file)), key_(key), instance_(std::move(instance)) {}
  LockFile file_;
  std::int32_t key_ = 0;
  std::string instance_;
};

// "0x92f (2351)"
[[nodiscard]] std::string key_text(std::int32_t key);

}  // namespace cellmirror
