// Gives what ROS 2 controllers want and what their robots do to their endpoints, each at its rate.
#pragma once

#include <map>
#include <string>

#include "app/snapshot/cell_state.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/engine/tick_state.hpp"
#include "rt_core/ports/trajectory_endpoint.hpp"

namespace cellmirror::app {

// One thread.
class ControllerPublisher {
 public:
  // Whether one is due by `by`, and when the next one will be; never: there is none.
  [[nodiscard]] bool due(const CellState& cell_state, Timestamp by) const;
  [[nodiscard]] Timestamp next(const CellState& cell_state) const;
  // Publishes what is due by `by`.
  void publish(const CellState& cell_state, const engine::TickState& tick, Timestamp now, Timestamp by);

 private:
  std::map<std::string, Timestamp> due_;  // by controller; none: at once
  ControllerState state_;                 // reused
};

}  // namespace cellmirror::app
