// Trajectories of ROS 2's controllers, and their bytes. Pure: no DDS library, no clock.
// Layouts: trajectory_msgs/JointTrajectory of common_interfaces; bytes: see cdr.hpp. SI: rad or m, s.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/dds/cdr.hpp"
#include "drivers/dds/ros2_messages.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/joint_trajectory.hpp"

namespace cellmirror::dds {

inline constexpr std::string_view kJointTrajectoryType = "trajectory_msgs::msg::dds_::JointTrajectory_";

// Form and limits only (kMaxTrajectoryPoints, kMaxTrajectoryJoints): values are checked where the trajectory is
// planned. After a fault the message's content is unspecified.
[[nodiscard]] CdrFault decode(std::span<const std::byte> payload, JointTrajectory& message);
// As members of other messages.
void read(CdrReader& in, JointTrajectory& message);
[[nodiscard]] Nanoseconds read_duration(CdrReader& in);

void encode(const JointTrajectory& message, std::vector<std::byte>& out);
void write(const TrajectoryPoint& point, CdrWriter& out);
void write_duration(Nanoseconds duration, CdrWriter& out);

}  // namespace cellmirror::dds
