#include "config/dds_network_reader.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "rt_core/base/ipv4_address.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

constexpr std::size_t kLongestPartition = 255;

std::vector<std::string> read_list(TableReader& table, const char* key, std::size_t most) {
  std::vector<std::string> texts = table.texts(key).value_or(std::vector<std::string>{});
  if (texts.size() <= most) return texts;
  table.error(key, fmt::format("{} has {} entries; the limit is {}", key, texts.size(), most));
  return {};
}

void refuse(TableReader& table, const char* key, std::string_view text) {
  table.error(key, fmt::format("\"{}\" is no IPv4 address with or without a port", printable(text)),
              "e.g. \"192.168.7.5\" or \"192.168.7.5:11811\"");
}

// The number of a server is its place in the list, as in ROS_DISCOVERY_SERVER; an empty text leaves a number out.
std::vector<DdsServer> read_servers(TableReader& table) {
  std::vector<DdsServer> servers;
  std::uint8_t id = 0;
  for (const std::string& text : read_list(table, "discovery_servers", kMostDiscoveryServers)) {
    const std::uint8_t own_id = id++;
    if (text.empty()) continue;
    const auto parsed = parse_ipv4_address(text);
    if (!parsed) {
      refuse(table, "discovery_servers", text);
      continue;
    }
    DdsServer server{.address = parsed->address, .id = own_id};
    if (parsed->port != 0) server.port = parsed->port;
    servers.push_back(server);
  }
  return servers;
}

std::vector<DdsPeer> read_peers(TableReader& table) {
  std::vector<DdsPeer> peers;
  for (const std::string& text : read_list(table, "peers", kMostDdsPeers)) {
    if (const auto parsed = parse_ipv4_address(text)) {
      peers.push_back({parsed->address, parsed->port});
    } else {
      refuse(table, "peers", text);
    }
  }
  return peers;
}

}  // namespace

DdsNetworkConfig read_dds_network(TableReader& dds) {
  DdsNetworkConfig network;
  network.discovery_servers = read_servers(dds);
  network.peers = read_peers(dds);
  network.multicast = dds.boolean("multicast").value_or(network.multicast);
  network.link = dds.choice<DdsLink>("link", {{"lan", DdsLink::lan}, {"lossy", DdsLink::lossy}}).value_or(network.link);
  if (!network.discovery_servers.empty() && (!network.peers.empty() || dds.has("multicast")))
    dds.error(network.peers.empty() ? "multicast" : "peers",
              "a client of discovery servers finds its peers by them alone", "remove this key, or discovery_servers");
  return network;
}

std::string read_partition(TableReader& table, const char* key) {
  const auto text = table.text(key);
  if (!text) return {};
  const bool plain =
      !text->empty() && text->size() <= kLongestPartition && printable(*text, kLongestPartition) == *text;
  if (plain && text->find_first_of("*?[") == std::string::npos) return *text;
  table.error(key, fmt::format("\"{}\" is not the name of a partition", printable(*text)),
              "1 to 255 printable characters without *, ? and [");
  return {};
}

}  // namespace cellmirror
