#include "app/snapshot/tick_poser.hpp"

#include <algorithm>

namespace cellmirror::app {

bool TickPoser::take(const CompiledCell& cell, const engine::TickState& tick) {
  const bool all_known = std::ranges::all_of(cell.robots, [&tick](const CompiledRobot& robot) {
    const engine::RobotTickState& from = tick.robots[robot.slot];
    return from.mode != engine::RobotMode::absent && from.joint_count == robot.joint_names.size();
  });
  if (all_known) take_known(cell, tick);
  return all_known;
}

void TickPoser::take_known(const CompiledCell& cell, const engine::TickState& tick) {
  for (const CompiledRobot& robot : cell.robots) {
    const engine::RobotTickState& from = tick.robots[robot.slot];
    for (std::size_t i = 0; i < from.joint_count; ++i) positions_[robot.slot][i] = from.joints[i].position;
  }
  compute_poses(cell, positions_, poses_);
}

}  // namespace cellmirror::app
