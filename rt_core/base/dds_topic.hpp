// Names of topics as people write them, and as DDS knows them.
#pragma once

#include <string>
#include <string_view>

namespace cellmirror {

// A ROS 2 name with its leading slash gets ROS 2's prefix for topics: "/joint_states" is "rt/joint_states" on DDS
// (ROS 2 design, "Topic and Service name mapping to DDS"). Any other text is a DDS name and stays as it is.
[[nodiscard]] std::string dds_topic(std::string_view written);

// Whether a DDS name can be that of a ROS 2 topic: "rt/" and names of letters, digits and underscores between single
// slashes, none of which begins with a digit.
[[nodiscard]] bool is_ros_topic(std::string_view dds_name);

}  // namespace cellmirror
