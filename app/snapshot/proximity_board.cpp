#include "app/snapshot/proximity_board.hpp"

#include <algorithm>
#include <utility>

namespace cellmirror::app {

void ProximityBoard::publish(std::shared_ptr<const ProximityState> state) {
  {
    const std::scoped_lock lock(mutex_);
    events_.insert(events_.end(), state->events.begin(), state->events.end());
    while (events_.size() > kKeptEvents) events_.pop_front();
    state_.swap(state);
  }
  // The state before is released here, after the lock.
}

std::shared_ptr<const ProximityState> ProximityBoard::latest() const {
  const std::scoped_lock lock(mutex_);
  return state_;
}

std::vector<ProximityEvent> ProximityBoard::events_after(std::uint64_t sequence) const {
  const std::scoped_lock lock(mutex_);
  const auto first = std::ranges::upper_bound(events_, sequence, {}, &ProximityEvent::sequence);
  return {first, events_.end()};
}

}  // namespace cellmirror::app
