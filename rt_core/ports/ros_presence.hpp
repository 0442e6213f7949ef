// How the gateway shows itself to programs of ROS 2: the [dds] table of the cell file. Plain data.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace cellmirror {

// Releases of ROS 2 whose messages differ. What is newer than the last one has its messages.
enum class RosDistribution : std::uint8_t { humble, jazzy, kilted };
inline constexpr std::array<std::string_view, 3> kRosDistributions = {"humble", "jazzy", "kilted"};

struct RosPresence {
  // Of the peers. None: no ros_discovery_info is published, since peers of another distribution could not read it, and
  // messages are those of Jazzy.
  std::optional<RosDistribution> distribution = {};
  std::string node_name = "cellmirror";

  [[nodiscard]] RosDistribution messages() const { return distribution.value_or(RosDistribution::jazzy); }
  auto operator<=>(const RosPresence&) const = default;
};

}  // namespace cellmirror
