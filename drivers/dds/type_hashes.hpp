// Type hashes of ROS 2's messages (RIHS01: REP 2011 and rosidl's hashing of type descriptions), by which its programs
// know since Iron that two mean the same. Pure.
#pragma once

#include <string>
#include <string_view>

#include "rt_core/ports/ros_presence.hpp"

namespace cellmirror::dds {

// SHA-256 in hexadecimal digits; empty: none is known, or the distribution has none. `type`: its name on DDS.
[[nodiscard]] std::string_view type_hash(std::string_view type, RosDistribution distribution);
// What readers and writers announce in USER_DATA, as rmw_dds_common has it: "typehash=RIHS01_...;", or nothing.
[[nodiscard]] std::string type_user_data(std::string_view type, RosDistribution distribution);

}  // namespace cellmirror::dds
