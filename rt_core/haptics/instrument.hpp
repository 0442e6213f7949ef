// The robot driven by a haptic device, data for the tick.
#pragma once

#include <array>
#include <cstdint>

#include "rt_core/base/pose.hpp"
#include "rt_core/haptics/settings.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::haptics {

// What the owner of the cell prepares off the tick for a channel. It outlives the channel's use of it.
struct Instrument {
  std::uint8_t slot = 0;
  std::uint8_t joint_count = 0;  // of the robot
  kinematics::Chain chain;       // from its base to its TCP; the joints of the robot that are on the way
  std::array<std::uint8_t, kMaxJointsPerRobot> variable_joint{};  // joint of the robot that a variable of the chain is
  Pose X_WB = Pose::Identity();  // its base in the world; it does not move while the channel is open
  JointValues lower{};           // rad or m, of the robot's joints
  JointValues upper{};
  HapticSettings settings;
};

}  // namespace cellmirror::haptics
