#include "app/workers/robot_motions.hpp"

namespace cellmirror::app {

bool read_motions(const CompiledCell& cell, const engine::TickState& tick,
                  std::vector<dynamics::RobotMotion>& motions) {
  motions.resize(cell.robots.size());
  for (std::size_t i = 0; i < cell.robots.size(); ++i) {
    const CompiledRobot& robot = cell.robots[i];
    const engine::RobotTickState& from = tick.robots[robot.slot];
    if (from.mode == engine::RobotMode::absent || from.joint_count != robot.joint_names.size()) return false;
    dynamics::RobotMotion& motion = motions[i];
    motion.mirrored = from.mode == engine::RobotMode::mirrored;
    motion.fresh = !motion.mirrored || from.state == DataState::fresh;
    motion.time = motion.mirrored ? from.receive_time : tick.time;
    for (std::size_t j = 0; j < from.joint_count; ++j) {
      motion.position[j] = from.joints[j].position;
      motion.velocity[j] = from.joints[j].velocity;
    }
  }
  return true;
}

}  // namespace cellmirror::app
