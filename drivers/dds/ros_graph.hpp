// Which nodes have which readers and writers: rmw_dds_common/ParticipantEntitiesInfo, by which ROS 2's programs show
// names of nodes, and its bytes. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/dds/message/guid.hpp"
#include "rt_core/ports/ros_presence.hpp"

namespace cellmirror::dds {

inline constexpr std::string_view kRosGraphType = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";
inline constexpr std::string_view kRosGraphTopic = "ros_discovery_info";

// Of a participant with one node.
struct RosGraph {
  Guid participant{};
  std::string node;  // in the namespace /
  std::vector<Guid> readers;
  std::vector<Guid> writers;
};

// A Gid has 24 bytes in Humble and 16 since Iron, where a reader takes nothing from one of the other size.
[[nodiscard]] std::size_t gid_bytes(RosDistribution distribution);
void encode(const RosGraph& graph, RosDistribution distribution, std::vector<std::byte>& out);

}  // namespace cellmirror::dds
