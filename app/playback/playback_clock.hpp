// The time of a recording that is played.
#pragma once

#include <atomic>

#include "rt_core/base/time.hpp"

namespace cellmirror::app {

// Stands still between two steps of the player, so that all that is done with a state is done at one time.
class PlaybackClock final : public Clock {
 public:
  // Relaxed: the number by itself is all that is read.
  [[nodiscard]] Timestamp now() const CELL_RT override { return Timestamp{now_ns_.load(std::memory_order_relaxed)}; }
  void set(Timestamp now) { now_ns_.store(now.ns, std::memory_order_relaxed); }

 private:
  std::atomic<std::int64_t> now_ns_{1};
};

}  // namespace cellmirror::app
