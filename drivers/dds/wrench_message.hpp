// geometry_msgs/WrenchStamped of ROS 2's common_interfaces, its bytes, and how it is made. Pure; see ros2_messages.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "drivers/dds/ros2_messages.hpp"
#include "rt_core/ports/force_state.hpp"

namespace cellmirror::dds {

inline constexpr std::string_view kWrenchStampedType = "geometry_msgs::msg::dds_::WrenchStamped_";

// N and Nm, in the frame `header.frame_id`.
struct WrenchStamped {
  Header header = {};
  std::array<double, 3> force{};
  std::array<double, 3> torque{};
};

// Little endian, with encapsulation header. `out` is overwritten and keeps its capacity.
void encode(const WrenchStamped& message, std::vector<std::byte>& out);

// What the surroundings do to the robot's TCP, in the frame "<robot>/tcp" of /tf. False where nothing tells of it or a
// number is not finite: such a force is not published.
[[nodiscard]] bool fill_tcp_wrench(RosTime stamp, const RobotForces& robot, WrenchStamped& message);

}  // namespace cellmirror::dds
