#include "app/gateway/findings_board.hpp"

#include <algorithm>
#include <utility>

namespace cellmirror::app {

void ProximityBoard::hang_up(std::shared_ptr<const ProximityState> state) {
  {
    const std::scoped_lock lock(mutex_);
    events_.insert(events_.end(), state->events.begin(), state->events.end());
    while (events_.size() > kKeptEvents) events_.pop_front();
    state_.swap(state);
  }
  // The state before is let go here, outside of the lock.
}

std::shared_ptr<const ProximityState> ProximityBoard::look() const {
  const std::scoped_lock lock(mutex_);
  return state_;
}

std::vector<ProximityEvent> ProximityBoard::events_after(std::uint64_t sequence) const {
  const std::scoped_lock lock(mutex_);
  const auto first = std::ranges::upper_bound(events_, sequence, {}, &ProximityEvent::sequence);
  return {first, events_.end()};
}

void RangeBoard::hang_up(std::shared_ptr<const RangeReadings> readings) {
  const std::scoped_lock lock(mutex_);
  readings_.swap(readings);
}

std::shared_ptr<const RangeReadings> RangeBoard::look() const {
  const std::scoped_lock lock(mutex_);
  return readings_;
}

}  // namespace cellmirror::app
