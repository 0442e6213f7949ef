// What a haptic channel has to know of the robot that is its instrument.
#pragma once

#include <memory>
#include <span>

#include "rt_core/base/result.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/haptics/haptic_channel.hpp"

namespace cellmirror::app {

// At the joint positions q[slot][joint] of all robots. Its base is the robot's ZP frame. Refused: see robot_chain(); a
// gripper that the robot has no joint for.
[[nodiscard]] Result<std::shared_ptr<const haptics::Instrument>> make_instrument(
    const Cell& cell, const RobotModel& robot, const haptics::HapticSettings& settings, std::span<const JointValues> q);

// Whether a channel that was opened with the one need not be reopened for the other. Settings are not compared.
[[nodiscard]] bool same_instrument(const haptics::Instrument& a, const haptics::Instrument& b);

}  // namespace cellmirror::app
