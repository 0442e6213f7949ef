#include "app/io/node_channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "app/io/can_tap.hpp"

namespace cellmirror::app {

NodeChannels::NodeChannels(const std::map<std::string, StreamConfig, std::less<>>& streams,
                           std::span<const IoNodeConfig> io_nodes, const Clock& clock, int fifo_priority, CanTap* tap) {
  const auto add = [&](const CanChannelConfig& config, const std::string& name) {
    if (find(config)) return;
    can::CanStreamOptions options{.thread_name = "can-nodes", .fifo_priority = fifo_priority, .open_channel = {}};
    if (tap != nullptr) options.open_channel = tap->opener(name);
    entries_.push_back({config, can::make_shared_channel(config, clock, std::move(options))});
  };
  for (const auto& [robot, stream] : streams) {
    if (const auto* device = std::get_if<Cia402DeviceConfig>(&stream)) add(device->channel, robot);
  }
  for (const IoNodeConfig& node : io_nodes) add(node.channel, fmt::format("io_node_{}", node.node_id));
}

std::shared_ptr<can::SharedChannel> NodeChannels::find(const CanChannelConfig& config) const {
  const auto found = std::ranges::find(entries_, config, &Entry::config);
  return found == entries_.end() ? nullptr : found->channel;
}

}  // namespace cellmirror::app
