// Where the workers hang up what they found, for the publisher and for status. Between workers only; the tick has no
// part in it, so a lock is allowed.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "rt_core/ports/proximity_state.hpp"

namespace cellmirror::app {

// Collisions and distances. Events are kept for readers that come less often than results are made.
class ProximityBoard {
 public:
  static constexpr std::size_t kKeptEvents = 4096;

  void hang_up(std::shared_ptr<const ProximityState> state);
  // The newest; null: nothing was computed yet.
  [[nodiscard]] std::shared_ptr<const ProximityState> look() const;
  // Those with a greater sequence, oldest first; of more than kKeptEvents only the newest.
  [[nodiscard]] std::vector<ProximityEvent> events_after(std::uint64_t sequence) const;

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const ProximityState> state_;
  std::deque<ProximityEvent> events_;
};

// The readings of all active sensors at one posture.
struct RangeReadings {
  std::uint64_t sequence = 0;  // counts from 1
  Timestamp posture_time;      // the tick's instant
  Timestamp finished;          // when the computation ended
  std::vector<RangeReading> readings;
};

class RangeBoard {
 public:
  void hang_up(std::shared_ptr<const RangeReadings> readings);
  // The newest; null: nothing was computed yet.
  [[nodiscard]] std::shared_ptr<const RangeReadings> look() const;

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const RangeReadings> readings_;
};

}  // namespace cellmirror::app
