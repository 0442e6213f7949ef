#include "config/node_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

// The robot of the first device of `streams` that has the number on the channel; null: there is none.
const std::string* robot_with_node(std::span<const RobotStream> streams, std::string_view endpoint, int number) {
  for (const RobotStream& stream : streams) {
    const auto* device = std::get_if<Cia402DeviceConfig>(&stream.config);
    if (device == nullptr || device->channel.endpoint != endpoint) continue;
    if (std::ranges::find(device->nodes, number, &DriveConfig::node_id) != device->nodes.end()) return &stream.robot;
  }
  return nullptr;
}

}  // namespace

void check_node_numbers(std::span<const RobotStream> streams, std::span<const IoNodeConfig> io_nodes,
                        Diagnostics& diagnostics) {
  const auto check = [&](std::span<const RobotStream> others, const std::string& endpoint, int number, Place place) {
    const std::string* robot = number > 0 ? robot_with_node(others, endpoint, number) : nullptr;
    if (robot == nullptr) return;
    diagnostics.error(std::move(place),
                      fmt::format("the drives of {} have a node {} on the channel {} too", printable(*robot), number,
                                  printable(endpoint)),
                      "give each node of a channel a number of its own");
  };
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const auto* device = std::get_if<Cia402DeviceConfig>(&streams[i].config);
    if (device == nullptr) continue;
    for (const DriveConfig& node : device->nodes)
      check(streams.first(i), device->channel.endpoint, node.node_id, node.place);
  }
  for (const IoNodeConfig& node : io_nodes) check(streams, node.channel.endpoint, node.node_id, node.place);
}

}  // namespace cellmirror
