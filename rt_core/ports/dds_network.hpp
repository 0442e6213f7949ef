// How the gateway finds its DDS peers: the [dds] table of the cell file. Plain data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cellmirror {

inline constexpr std::size_t kMostDiscoveryServers = 8;
inline constexpr std::size_t kMostDdsPeers = 64;

struct DdsServer {
  std::string address;         // IPv4, numeric
  std::uint16_t port = 11811;  // UDP
  std::uint8_t id = 0;         // the server's number: -i of fast-discovery-server, its place in ROS_DISCOVERY_SERVER

  auto operator<=>(const DdsServer&) const = default;
};

struct DdsPeer {
  std::string address;     // IPv4, numeric
  std::uint16_t port = 0;  // of its discovery traffic; 0: those of the first eight participants there

  auto operator<=>(const DdsPeer&) const = default;
};

// Of the links to the peers.
enum class DdsLink : std::uint8_t {
  lan,
  lossy,  // radio, tunnels: datagrams that need no IP fragments, longer leases, more announcements
};

struct DdsNetworkConfig {
  std::vector<DdsServer> discovery_servers;  // none: peers find each other by themselves
  std::vector<DdsPeer> peers;                // found by unicast
  bool multicast = true;                     // otherwise: only the peers and this machine
  DdsLink link = DdsLink::lan;

  auto operator<=>(const DdsNetworkConfig&) const = default;
};

}  // namespace cellmirror
