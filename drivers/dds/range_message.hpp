// sensor_msgs/Range of ROS 2's common_interfaces, and its bytes. Pure; see ros2_messages.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "drivers/dds/ros2_messages.hpp"

namespace cellmirror::dds {

inline constexpr std::string_view kRangeType = "sensor_msgs::msg::dds_::Range_";
inline constexpr std::uint8_t kUltrasound = 0;

// The sensor looks along the x axis of `header.frame_id`. Lengths in m, angles in rad.
struct Range {
  Header header = {};
  std::uint8_t radiation_type = kUltrasound;
  float field_of_view = 0;  // the whole opening angle
  float min_range = 0;
  float max_range = 0;
  // REP 117: +infinity where nothing is within max_range, -infinity where something is too near to be measured, NaN
  // where the reading is wrong or in doubt.
  float range = 0;
  // Since ROS 2 Iron, the last member; 0: not known. Always written: readers of Humble's type, which ends before it,
  // ignore what follows (XCDR version 1), readers of the newer type refuse a message without it.
  float variance = 0;
};

// Little endian, with encapsulation header. `out` is overwritten and keeps its capacity.
void encode(const Range& message, std::vector<std::byte>& out);

}  // namespace cellmirror::dds
