// Wakes a waiting worker thread from another one. Not for the tick: both sides make system calls.
#pragma once

#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

// Any number of wakers, one waiter. A wake before the wait is not lost.
class WakeSignal {
 public:
  WakeSignal();
  WakeSignal(const WakeSignal&) = delete;
  WakeSignal& operator=(const WakeSignal&) = delete;

  void wake() noexcept;
  // True where it was woken, false where `timeout` ran out.
  bool wait(Nanoseconds timeout) noexcept;
  // Readable while it was woken and wait() was not called since: for a waiter that waits for other descriptors too.
  [[nodiscard]] int descriptor() const noexcept { return event_.get(); }

 private:
  Descriptor event_;
};

}  // namespace cellmirror
