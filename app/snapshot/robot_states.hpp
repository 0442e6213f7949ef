// Joins the tick's numbers with the cell's names and poses for everything that leaves the gateway.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/tick_poser.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/engine/tick_state.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror::app {

// Keeps its buffers from call to call. One thread.
class RobotStateBuilder {
 public:
  // All robots of the cell at that tick, in the order of the slots; valid until the next call.
  std::span<const RobotState> build(const CellState& cell_state, const engine::TickState& state);
  // After build(): the frames of the robots' chains for /tf, from "world" over the base and the joints to the TCP.
  // `wanted` says for each robot of the cell whether it is in.
  std::span<const FramePose> frames(const CellState& cell_state, const std::vector<bool>& wanted);
  // Of all nodes, at the tick of the last build().
  [[nodiscard]] const CellPoses& poses() const { return poser_.poses(); }

 private:
  TickPoser poser_;
  std::vector<RobotState> robots_;
  std::vector<FramePose> frames_;
};

}  // namespace cellmirror::app
