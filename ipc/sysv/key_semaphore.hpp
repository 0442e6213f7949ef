// The owner of a key, provided by the kernel to every process that can see the key's queue.
#pragma once

#include <cstdint>

#include "rt_core/base/result.hpp"

namespace cellmirror {

// A System V semaphore of the queue's key, raised by its owner with SEM_UNDO: the kernel lowers it when that process
// ends, however that ends. It has the same reach as the queue, which lock files have not: two gateways of one user may
// have different runtime folders (a login session and sudo, a unit and a shell). Moved, not copied.
class KeySemaphore {
 public:
  // Refused where another process holds it, named by its number, and where the semaphore is another user's.
  static Result<KeySemaphore> take(std::int32_t key);

  KeySemaphore() = default;
  KeySemaphore(KeySemaphore&& other) noexcept;
  KeySemaphore& operator=(KeySemaphore&& other) noexcept;
  ~KeySemaphore();  // removes it

  // Whether it is still there: logind removes it with the queues at log-out.
  [[nodiscard]] bool in_place() const;
  void release();

  // Whether any process holds it, as far as visible to this user.
  [[nodiscard]] static bool is_held(std::int32_t key);

 private:
  explicit KeySemaphore(int id) : id_(id) {}
  int id_ = -1;
};

}  // namespace cellmirror
