// Publishes collisions and distances to the outputs, the renderer and the reports.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "rt_core/ports/proximity_state.hpp"

namespace cellmirror::app {

// As Board, with a history of events for readers that read less often than results are published.
class ProximityBoard {
 public:
  static constexpr std::size_t kKeptEvents = 4096;

  void publish(std::shared_ptr<const ProximityState> state);
  // The newest; null: nothing was computed yet.
  [[nodiscard]] std::shared_ptr<const ProximityState> latest() const;
  // Those with a greater sequence, oldest first; of more than kKeptEvents only the newest.
  [[nodiscard]] std::vector<ProximityEvent> events_after(std::uint64_t sequence) const;

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const ProximityState> state_;
  std::deque<ProximityEvent> events_;
};

}  // namespace cellmirror::app
