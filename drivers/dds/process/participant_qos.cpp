#include "drivers/dds/process/participant_qos.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <algorithm>
#include <array>
#include <cstdint>
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

namespace cellmirror::dds {

namespace {

namespace fd = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

// RTPS 2.3, 9.6.1.1: a participant's own ports are kFirstPort + kPortsPerDomain * domain + 2 * participant, and one
// more.
constexpr int kFirstPort = 7410;
constexpr int kGroupPort = 7400;  // likewise, of the group
constexpr int kPortsPerDomain = 250;
constexpr std::uint32_t kSocketBufferBytes = 4U << 20U;  // the kernel cuts it to net.core.rmem_max
constexpr int kPeersPerHost = 64;                        // participants of this host that are found without multicast
constexpr int kPeersPerMachine = 8;  // participants of another machine that are found by its address alone
constexpr int kMaxPort = 65534;      // of discovery: the one above is the same participant's for data
// What an Ethernet frame holds without IP fragments, of which one that is lost loses the whole datagram.
constexpr std::uint32_t kDatagramWithoutFragments = 1400;
constexpr int kLease_s = 10;
// Longer than that of a discovery server, 20 s: after a cut Fast DDS 2.9 finds its peers again only where the client
// has forgotten the server no later than the server has forgotten the client.
constexpr int kLongLease_s = 30;
constexpr char kDiscoveryGroup[] = "239.255.0.1";  // RTPS 2.3, 9.6.1.4

rtps::Locator_t locator_of(const std::string& address, std::uint32_t port) {
  rtps::Locator_t locator;
  locator.kind = LOCATOR_KIND_UDPv4;
  rtps::IPLocator::setIPv4(locator, address);
  locator.port = port;
  return locator;
}

// Where a participant of another machine may listen for discovery (RTPS 2.3, 9.6.1.1).
void add_peer(rtps::LocatorList_t& peers, int domain, const DdsPeer& peer) {
  if (peer.port != 0) return peers.push_back(locator_of(peer.address, peer.port));
  for (int participant = 0; participant < kPeersPerMachine; ++participant) {
    const int port = kFirstPort + kPortsPerDomain * domain + 2 * participant;
    if (port <= kMaxPort) peers.push_back(locator_of(peer.address, static_cast<std::uint32_t>(port)));
  }
}

// By multicast on that interface, and by unicast to the first participants of this host, which also works where the
// interface has no multicast (a bare `lo` in a network namespace).
void discover_by_peers(rtps::BuiltinAttributes& builtin, int domain, const std::string& address,
                       const DdsNetworkConfig& network) {
  // With its port: without one the library takes the group for a machine with many participants.
  const auto group_port = static_cast<std::uint32_t>(kGroupPort + kPortsPerDomain * domain);
  if (network.multicast) builtin.initialPeersList.push_back(locator_of(kDiscoveryGroup, group_port));
  builtin.initialPeersList.push_back(locator_of(address, 0));
  for (const DdsPeer& peer : network.peers) add_peer(builtin.initialPeersList, domain, peer);
  if (network.multicast) return;
  // Otherwise the library would listen on the group.
  builtin.avoid_builtin_multicast = true;
  builtin.metatrafficUnicastLocatorList.push_back(locator_of(address, 0));
}

// The GUID prefix of a discovery server by its number, as fast-discovery-server and ROS_DISCOVERY_SERVER have it.
rtps::GuidPrefix_t prefix_of_server(std::uint8_t id) {
  rtps::GuidPrefix_t prefix;
  constexpr std::array<rtps::octet, 12> kServer{0x44, 0x53, 0x00, 0x5f, 0x45, 0x50, 0x52, 0x4f, 0x53, 0x49, 0x4d, 0x41};
  std::ranges::copy(kServer, std::begin(prefix.value));
  prefix.value[2] = id;
  return prefix;
}

void discover_by_servers(rtps::BuiltinAttributes& builtin, const DdsNetworkConfig& network) {
  auto& discovery = builtin.discovery_config;
  discovery.discoveryProtocol = rtps::DiscoveryProtocol_t::CLIENT;
  for (const DdsServer& server : network.discovery_servers) {
    rtps::RemoteServerAttributes remote;
    remote.guidPrefix = prefix_of_server(server.id);
    remote.metatrafficUnicastLocatorList.push_back(locator_of(server.address, server.port));
    discovery.m_DiscoveryServers.push_back(remote);
  }
}

void set_discovery(fd::DomainParticipantQos& qos, int domain, const std::string& address,
                   const DdsNetworkConfig& network) {
  auto& builtin = qos.wire_protocol().builtin;
  auto& discovery = builtin.discovery_config;
  if (network.discovery_servers.empty()) {
    discover_by_peers(builtin, domain, address, network);
  } else {
    discover_by_servers(builtin, network);
  }
  const bool lossy = network.link == DdsLink::lossy;
  const bool by_servers = !network.discovery_servers.empty();
  discovery.leaseDuration = {lossy || by_servers ? kLongLease_s : kLease_s, 0};
  discovery.leaseDuration_announcementperiod = {1, 0};
  if (lossy) discovery.initial_announcements = {20, {0, 250'000'000}};
}

// The library ends the process over a port beyond 65535.
int peers_per_host(int domain) {
  return std::min(kPeersPerHost, (kMaxPort - kFirstPort - kPortsPerDomain * domain) / 2);
}

// DDS Security 1.1, 9.3 to 9.5: the builtin plugins.
void set_security(fd::DomainParticipantQos& qos, const DdsSecurityConfig& security) {
  if (!security.enabled()) return;
  auto& properties = qos.properties().properties();
  const auto set = [&properties](std::string name, std::string value) {
    properties.emplace_back("dds.sec." + std::move(name), std::move(value));
  };
  const auto file = [](const std::string& path) { return "file://" + path; };
  set("auth.plugin", "builtin.PKI-DH");
  set("auth.builtin.PKI-DH.identity_ca", file(security.identity_ca));
  set("auth.builtin.PKI-DH.identity_certificate", file(security.certificate));
  set("auth.builtin.PKI-DH.private_key", file(security.private_key));
  set("access.plugin", "builtin.Access-Permissions");
  set("access.builtin.Access-Permissions.permissions_ca", file(security.permissions_ca));
  set("access.builtin.Access-Permissions.governance", file(security.governance));
  set("access.builtin.Access-Permissions.permissions", file(security.permissions));
  set("crypto.plugin", "builtin.AES-GCM-GMAC");
}

}  // namespace

fd::DomainParticipantQos participant_qos(const OpenParticipant& wanted) {
  const auto& [domain, address, security, network] = wanted;
  fd::DomainParticipantQos qos;
  qos.name("cellmirror");
  // By this programs of ROS 2 know their kind.
  constexpr std::string_view kEnclave = "enclave=/;";
  qos.user_data().setValue({kEnclave.begin(), kEnclave.end()});
  // UDP alone: shared memory is hardly faster at these sizes and leaves its segments behind after kill -9
  // (docs/decisions/0003-dds-transports.md).
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.push_back(address);
  udp->receiveBufferSize = kSocketBufferBytes;
  udp->sendBufferSize = kSocketBufferBytes;
  udp->non_blocking_send = true;
  if (network.link == DdsLink::lossy) udp->maxMessageSize = kDatagramWithoutFragments;
  udp->maxInitialPeersRange = static_cast<std::uint32_t>(peers_per_host(domain));
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  set_discovery(qos, domain, address, network);
  set_security(qos, security);
  return qos;
}

}  // namespace cellmirror::dds
