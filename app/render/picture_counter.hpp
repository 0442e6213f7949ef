// Counts the updates of the picture, for view sequences that go by STEPS (STVW).
#pragma once

#include <atomic>
#include <cstdint>

namespace cellmirror::app {

// It goes on at the rate of the settings where nobody looks, and without pictures too. Relaxed: nothing hangs on it but
// where a view stands. Any thread.
class PictureCounter {
 public:
  [[nodiscard]] std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }
  void add() { count_.fetch_add(1, std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> count_{0};
};

}  // namespace cellmirror::app
