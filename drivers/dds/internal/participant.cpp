#include "drivers/dds/internal/participant.hpp"

#include <arpa/inet.h>
#include <fmt/core.h>
#include <ifaddrs.h>

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <algorithm>
#include <exception>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "drivers/dds/internal/bytes_type.hpp"
#include "drivers/dds/internal/library_log.hpp"
#include "drivers/dds/presence.hpp"
#include "drivers/dds/type_hashes.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::dds {

namespace {

namespace fd = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

// RTPS 2.3, 9.6.1.1: a participant's own ports are kFirstPort + kPortsPerDomain * domain + 2 * participant, and one
// more.
constexpr int kFirstPort = 7410;
constexpr int kPortsPerDomain = 250;
constexpr int kMaxDomain = 232;  // beyond it the ports pass 65535
constexpr std::size_t kMaxTopicLength = 255;
constexpr std::uint32_t kSocketBufferBytes = 4U << 20U;  // the kernel cuts it to net.core.rmem_max
constexpr int kPeersPerHost = 64;                        // participants of this host that are found without multicast
constexpr char kDiscoveryGroup[] = "239.255.0.1";        // RTPS 2.3, 9.6.1.4

std::vector<std::string> ipv4_addresses() {
  std::vector<std::string> found;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return found;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    if (entry->ifa_addr == nullptr || entry->ifa_addr->sa_family != AF_INET) continue;
    char text[INET_ADDRSTRLEN] = {};
    const auto* address = reinterpret_cast<const sockaddr_in*>(entry->ifa_addr);
    if (inet_ntop(AF_INET, &address->sin_addr, text, sizeof text) != nullptr) found.emplace_back(text);
  }
  freeifaddrs(list);
  return found;
}

Result<void> check_address(const std::string& address) {
  std::string known;
  for (const std::string& own : ipv4_addresses()) {
    if (own == address) return {};
    known += (known.empty() ? "" : ", ") + own;
  }
  return fail(fmt::format("'{}' is no IPv4 address of this machine", printable(address)),
              known.empty() ? "bring an interface up: ip link set lo up" : "use one of: " + known);
}

// Discovery by multicast on that interface, and by unicast to the first participants of this host, which also works
// where the interface has no multicast (a bare `lo` in a network namespace).
void set_discovery(fd::DomainParticipantQos& qos, const std::string& address) {
  auto& builtin = qos.wire_protocol().builtin;
  rtps::Locator_t multicast;
  multicast.kind = LOCATOR_KIND_UDPv4;
  rtps::IPLocator::setIPv4(multicast, kDiscoveryGroup);
  rtps::Locator_t own_host;
  own_host.kind = LOCATOR_KIND_UDPv4;
  rtps::IPLocator::setIPv4(own_host, address);
  builtin.initialPeersList.push_back(multicast);
  builtin.initialPeersList.push_back(own_host);
  builtin.discovery_config.leaseDuration = {10, 0};
  builtin.discovery_config.leaseDuration_announcementperiod = {1, 0};
}

// The library ends the process over a port beyond 65535.
int peers_per_host(int domain) { return std::min(kPeersPerHost, (65534 - kFirstPort - kPortsPerDomain * domain) / 2); }

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

// Why the library, which gives no reason, may have made no participant.
std::string remedy_for(const DdsSecurityConfig& security) {
  if (!security.enabled()) return "look whether the UDP ports of the domain are free (7400 + 250 * domain and above)";
  return "look at the files of [dds.security]: the key belongs to the certificate, the CAs have signed the others, "
         "the subject in the permissions is that of the certificate, the dates are valid (docs/dds.md)";
}

std::vector<eprosima::fastrtps::rtps::octet> octets_of(std::string_view text) { return {text.begin(), text.end()}; }

fd::DomainParticipantQos participant_qos(int domain, const std::string& address, const DdsSecurityConfig& security) {
  fd::DomainParticipantQos qos;
  qos.name("cellmirror");
  // By this programs of ROS 2 know their kind.
  qos.user_data().setValue(octets_of("enclave=/;"));
  // UDP alone: shared memory is hardly faster at these sizes and leaves its segments behind after kill -9
  // (docs/decisions/0003-dds-transports.md).
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.push_back(address);
  udp->receiveBufferSize = kSocketBufferBytes;
  udp->sendBufferSize = kSocketBufferBytes;
  udp->non_blocking_send = true;
  udp->maxInitialPeersRange = static_cast<std::uint32_t>(peers_per_host(domain));
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  set_discovery(qos, address);
  set_security(qos, security);
  return qos;
}

Guid guid_of(const rtps::GUID_t& guid) {
  Guid out{};
  std::size_t at = 0;
  for (const auto byte : guid.guidPrefix.value) out[at++] = byte;
  for (const auto byte : guid.entityId.value) out[at++] = byte;
  return out;
}

class PresenceSetting {
 public:
  static PresenceSetting& instance() {
    static PresenceSetting setting;
    return setting;
  }
  void set(const RosPresence& presence) {
    const std::scoped_lock lock(mutex_);
    presence_ = presence;
  }
  [[nodiscard]] RosPresence get() {
    const std::scoped_lock lock(mutex_);
    return presence_;
  }

 private:
  std::mutex mutex_;
  RosPresence presence_;
};

template <class Qos>
void set_common(Qos& qos, const EndpointConfig& config, RosDistribution distribution) {
  qos.user_data().setValue(octets_of(type_user_data(config.type, distribution)));
  qos.reliability().kind = config.reliable ? fd::RELIABLE_RELIABILITY_QOS : fd::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind = fd::VOLATILE_DURABILITY_QOS;
  qos.history().kind = fd::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = config.depth;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  qos.data_sharing().off();
}

}  // namespace

Result<void> check_domain(int domain) {
  if (domain >= 0 && domain <= kMaxDomain) return {};
  return fail(fmt::format("DDS domain {} does not exist", domain), fmt::format("use 0 to {}", kMaxDomain));
}

Result<void> check_topic(std::string_view topic) {
  if (topic.empty() || topic.size() > kMaxTopicLength) {
    return fail(fmt::format("the DDS topic '{}' is empty or too long", printable(topic)),
                fmt::format("use 1 to {} characters; ROS 2's topic /x is rt/x here", kMaxTopicLength));
  }
  return {};
}

void set_ros_presence(const RosPresence& presence) { PresenceSetting::instance().set(presence); }

Participant::Participant(std::shared_ptr<fd::DomainParticipantFactory> factory, RosPresence presence)
    : factory_(std::move(factory)), presence_(std::move(presence)) {}

Result<void> Participant::open_graph() {
  if (!presence_.distribution) return {};
  const auto made = make_writer({std::string(kRosGraphTopic), kRosGraphType, true, 1, false, true}, nullptr);
  if (!made) return std::unexpected(made.error());
  graph_.participant = guid_of(participant_->guid());
  graph_.node = presence_.node_name;
  graph_writer_ = *made;
  publish_graph();
  return {};
}

// Under the mutex.
void Participant::publish_graph() {
  if (graph_writer_ == nullptr) return;
  BytesSample sample;
  encode(graph_, *presence_.distribution, sample.payload);
  graph_writer_->write(&sample);
}

Result<std::shared_ptr<Participant>> Participant::shared(int domain, const std::string& interface_address,
                                                         const DdsSecurityConfig& security) {
  static std::mutex mutex;
  static std::map<std::tuple<int, std::string, DdsSecurityConfig>, std::weak_ptr<Participant>> participants;
  if (auto ok = check_domain(domain); !ok) return std::unexpected(ok.error());
  if (auto ok = check_address(interface_address); !ok) return std::unexpected(ok.error());
  const std::scoped_lock lock(mutex);
  auto& entry = participants[{domain, interface_address, security}];
  if (auto existing = entry.lock()) return existing;
  try {
    redirect_library_log();
    std::shared_ptr<Participant> made(
        new Participant(fd::DomainParticipantFactory::get_shared_instance(), PresenceSetting::instance().get()));
    const auto as_domain = static_cast<fd::DomainId_t>(domain);
    made->participant_ =
        made->factory_->create_participant(as_domain, participant_qos(domain, interface_address, security));
    if (made->participant_ == nullptr) {
      return fail(fmt::format("no DDS participant in domain {} on {}", domain, interface_address),
                  remedy_for(security));
    }
    made->publisher_ = made->participant_->create_publisher(fd::PublisherQos{});
    made->subscriber_ = made->participant_->create_subscriber(fd::SubscriberQos{});
    if (made->publisher_ == nullptr || made->subscriber_ == nullptr)
      return fail("DDS refused a publisher or subscriber");
    // Permissions may forbid it: names of nodes are no reason to be silent.
    if (auto opened = made->open_graph(); !opened) log_warning("dds.graph", "{}", opened.error().text());
    entry = made;
    return made;
  } catch (const std::exception& error) {
    return fail(fmt::format("DDS domain {} on {}: {}", domain, interface_address, error.what()));
  }
}

Participant::~Participant() {
  if (participant_ == nullptr) return;
  try {
    participant_->delete_contained_entities();
    factory_->delete_participant(participant_);
  } catch (const std::exception&) {  // nothing is left to be done about it
  }
}

Result<fd::Topic*> Participant::topic(const EndpointConfig& config) {
  if (auto ok = check_topic(config.topic); !ok) return std::unexpected(ok.error());
  const std::string type(config.type);
  if (fd::TopicDescription* existing = participant_->lookup_topicdescription(config.topic)) {
    if (existing->get_type_name() == type) return static_cast<fd::Topic*>(existing);
    return fail(fmt::format("topic {} carries {} already, not {}", config.topic, existing->get_type_name(), type),
                "choose another topic");
  }
  fd::TypeSupport support(new BytesType(type));
  support.register_type(participant_);
  fd::Topic* made = participant_->create_topic(config.topic, type, fd::TopicQos{});
  if (made == nullptr) return fail(fmt::format("DDS refused the topic {}", printable(config.topic)));
  return made;
}

Result<fd::DataReader*> Participant::add_reader(const EndpointConfig& config, fd::DataReaderListener* listener) {
  const std::scoped_lock lock(mutex_);
  try {
    const auto of_topic = topic(config);
    if (!of_topic) return std::unexpected(of_topic.error());
    fd::DataReaderQos qos;
    set_common(qos, config, presence_.messages());
    fd::DataReader* made = subscriber_->create_datareader(*of_topic, qos, listener);
    if (made == nullptr) return fail(fmt::format("DDS refused a reader of {}", printable(config.topic)));
    graph_.readers.push_back(guid_of(made->guid()));
    publish_graph();
    return made;
  } catch (const std::exception& error) {
    return fail(fmt::format("a DDS reader of {}: {}", printable(config.topic), error.what()));
  }
}

Result<fd::DataWriter*> Participant::add_writer(const EndpointConfig& config, fd::DataWriterListener* listener) {
  const std::scoped_lock lock(mutex_);
  auto made = make_writer(config, listener);
  if (!made) return made;
  graph_.writers.push_back(guid_of((*made)->guid()));
  publish_graph();
  return made;
}

Result<fd::DataWriter*> Participant::make_writer(const EndpointConfig& config, fd::DataWriterListener* listener) {
  try {
    const auto of_topic = topic(config);
    if (!of_topic) return std::unexpected(of_topic.error());
    fd::DataWriterQos qos;
    set_common(qos, config, presence_.messages());
    if (config.transient_local) qos.durability().kind = fd::TRANSIENT_LOCAL_DURABILITY_QOS;
    qos.publish_mode().kind = config.large ? fd::ASYNCHRONOUS_PUBLISH_MODE : fd::SYNCHRONOUS_PUBLISH_MODE;
    qos.reliability().max_blocking_time = {0, 1'000'000};                // how long write() may wait for a lock: 1 ms
    qos.reliable_writer_qos().times.heartbeatPeriod = {0, 100'000'000};  // so that a lost last sample is noticed soon
    fd::DataWriter* made = publisher_->create_datawriter(*of_topic, qos, listener);
    if (made == nullptr) return fail(fmt::format("DDS refused a writer of {}", printable(config.topic)));
    return made;
  } catch (const std::exception& error) {
    return fail(fmt::format("a DDS writer of {}: {}", printable(config.topic), error.what()));
  }
}

void Participant::remove(fd::DataReader* reader) {
  const std::scoped_lock lock(mutex_);
  std::erase(graph_.readers, guid_of(reader->guid()));
  subscriber_->delete_datareader(reader);
  publish_graph();
}

void Participant::remove(fd::DataWriter* writer) {
  const std::scoped_lock lock(mutex_);
  std::erase(graph_.writers, guid_of(writer->guid()));
  publisher_->delete_datawriter(writer);
  publish_graph();
}

}  // namespace cellmirror::dds
