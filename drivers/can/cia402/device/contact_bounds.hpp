// What a robot's contacts leave of the velocities of its joints. Pure.
#pragma once

#include <array>

#include "drivers/can/cia402/device/motor_model.hpp"
#include "rt_core/base/capacity.hpp"
#include "rt_core/ports/robot_contacts.hpp"

namespace cellmirror::can {

using JointVelocities = std::array<double, kMaxJointsPerRobot>;
using JointBounds = std::array<VelocityBounds, kMaxJointsPerRobot>;

// A joint deepens a contact no faster than the others, at their present `velocities` [rad/s or m/s], leave it; where
// those do not, it stands. Motion that leaves the contact is free, and no joint is pushed. A joint whose share in the
// contact is below a hundredth of the largest joint's is left out.
[[nodiscard]] JointBounds contact_bounds(const RobotContacts& contacts, const JointVelocities& velocities);

}  // namespace cellmirror::can
