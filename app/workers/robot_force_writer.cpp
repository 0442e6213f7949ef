#include "app/workers/robot_force_writer.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

namespace cellmirror::app {

namespace {

// Of the device that moves the robot; null: none does.
const HapticState* device_of(const CellState& cell_state, const engine::TickState& tick, std::string_view robot) {
  const auto found = std::ranges::find(cell_state.haptics, robot, &HapticSnapshot::robot);
  if (found == cell_state.haptics.end()) return nullptr;
  const HapticState& state = tick.haptics[found->channel];
  return state.phase == HapticPhase::closed ? nullptr : &state;
}

// Writes the drive efforts; for a robot without masses the efforts that the load exerts on its joints, as while a
// haptic device moves it. They are the negative drive efforts.
void write_computed(const RobotForces& robot, RobotForceChannel& channel) {
  const double sign = robot.computed ? 1.0 : -1.0;
  JointValues efforts{};
  const std::size_t count = std::min(robot.joints.size(), efforts.size());
  for (std::size_t i = 0; i < count; ++i) efforts[i] = sign * robot.joints[i].effort;
  channel.write(robot.tcp_T.force, std::span(efforts).first(count));
}

}  // namespace

void write_robot_forces(const CellState& cell_state, const engine::TickState& tick, const ForceState& forces) {
  for (const RobotForceSnapshot& buffer : cell_state.robot_forces) {
    const auto computed = std::ranges::find(forces.robots, buffer.robot, &RobotForces::id);
    if (const HapticState* device = device_of(cell_state, tick, buffer.robot)) {
      const std::size_t joints = tick.robots[device->slot].joint_count;
      buffer.channel->write(device->force_E, std::span(device->joint_torques).first(joints));
    } else if (computed != forces.robots.end()) {
      write_computed(*computed, *buffer.channel);
    } else {
      buffer.channel->write(Eigen::Vector3d::Zero(), {});
    }
  }
}

}  // namespace cellmirror::app
