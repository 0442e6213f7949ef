#include "drivers/dds/internal/domain_participant.hpp"

#include <fmt/core.h>

#include <exception>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <map>
#include <tuple>
#include <utility>

#include "drivers/dds/internal/bytes_type.hpp"
#include "drivers/dds/internal/endpoint_qos.hpp"
#include "drivers/dds/internal/library_guid.hpp"
#include "drivers/dds/internal/library_log.hpp"
#include "drivers/dds/internal/participant_qos.hpp"
#include "drivers/dds/internal/process_setting.hpp"
#include "drivers/dds/internal/service_clients.hpp"
#include "drivers/dds/network.hpp"
#include "drivers/dds/presence.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::dds {

namespace {

namespace fd = eprosima::fastdds::dds;

constexpr std::size_t kMaxTopicLength = 255;

// Why the library, which gives no reason, may have made no participant.
std::string remedy_for(const DdsSecurityConfig& security) {
  if (!security.enabled()) return "look whether the UDP ports of the domain are free (7400 + 250 * domain and above)";
  return "look at the files of [dds.security]: the key belongs to the certificate, the CAs have signed the others, "
         "the subject in the permissions is that of the certificate, the dates are valid (docs/dds.md)";
}

ProcessSetting<RosPresence>& presence_setting() {
  static ProcessSetting<RosPresence> setting;
  return setting;
}

ProcessSetting<DdsNetworkConfig>& network_setting() {
  static ProcessSetting<DdsNetworkConfig> setting;
  return setting;
}

}  // namespace

Result<void> check_topic(std::string_view topic) {
  if (topic.empty() || topic.size() > kMaxTopicLength) {
    return fail(fmt::format("the DDS topic '{}' is empty or too long", printable(topic)),
                fmt::format("use 1 to {} characters; ROS 2's topic /x is rt/x here", kMaxTopicLength));
  }
  return {};
}

void set_ros_presence(const RosPresence& presence) { presence_setting().set(presence); }

void set_network(const DdsNetworkConfig& network) { network_setting().set(network); }

DomainParticipant::DomainParticipant(RosPresence presence, DdsNetworkConfig network)
    : factory_(fd::DomainParticipantFactory::get_shared_instance()),
      clients_(std::make_unique<ServiceClients>()),
      presence_(std::move(presence)),
      network_(std::move(network)) {}

Result<void> DomainParticipant::open(int domain, const std::string& address, const DdsSecurityConfig& security) {
  const auto as_domain = static_cast<fd::DomainId_t>(domain);
  participant_ = factory_->create_participant(as_domain, participant_qos(domain, address, security, network_),
                                              clients_.get(), fd::StatusMask::none());
  if (participant_ == nullptr)
    return fail(fmt::format("no DDS participant in domain {} on {}", domain, address), remedy_for(security));
  // Permissions may forbid it: names of nodes are no reason to be silent.
  if (auto opened = open_graph(); !opened) log_warning("dds.graph", "{}", opened.error().text());
  return {};
}

Result<void> DomainParticipant::open_graph() {
  if (!presence_.distribution) return {};
  const EndpointConfig config{std::string(kRosGraphTopic), kRosGraphType, true, 1, false, true};
  const auto of_topic = topic(config);
  if (!of_topic) return std::unexpected(of_topic.error());
  graph_publisher_ = participant_->create_publisher(fd::PublisherQos{});
  if (graph_publisher_ == nullptr) return fail("DDS refused a publisher");
  graph_writer_ =
      graph_publisher_->create_datawriter(*of_topic, writer_qos(config, presence_.messages(), network_.link));
  if (graph_writer_ == nullptr) return fail(fmt::format("DDS refused a writer of {}", config.topic));
  graph_.participant = guid_of(participant_->guid());
  graph_.node = presence_.node_name;
  publish_graph();
  return {};
}

// Under the mutex.
void DomainParticipant::publish_graph() {
  if (graph_writer_ == nullptr) return;
  BytesSample sample;
  encode(graph_, *presence_.distribution, sample.payload);
  graph_writer_->write(&sample);
}

Result<std::shared_ptr<DomainParticipant>> DomainParticipant::shared(int domain, const std::string& interface_address,
                                                                     const DdsSecurityConfig& security) {
  static std::mutex mutex;
  static std::map<std::tuple<int, std::string, DdsSecurityConfig>, std::weak_ptr<DomainParticipant>> participants;
  if (auto ok = check_domain(domain); !ok) return std::unexpected(ok.error());
  if (auto ok = check_address(interface_address); !ok) return std::unexpected(ok.error());
  const std::scoped_lock lock(mutex);
  auto& entry = participants[{domain, interface_address, security}];
  if (auto existing = entry.lock()) return existing;
  try {
    redirect_library_log();
    std::shared_ptr<DomainParticipant> made(new DomainParticipant(presence_setting().get(), network_setting().get()));
    if (auto opened = made->open(domain, interface_address, security); !opened) return std::unexpected(opened.error());
    entry = made;
    return made;
  } catch (const std::exception& error) {
    return fail(fmt::format("DDS domain {} on {}: {}", domain, interface_address, error.what()));
  }
}

DomainParticipant::~DomainParticipant() {
  if (participant_ == nullptr) return;
  try {
    participant_->delete_contained_entities();
    factory_->delete_participant(participant_);
  } catch (const std::exception&) {  // nothing is left to be done about it
  }
}

Result<fd::Topic*> DomainParticipant::topic(const EndpointConfig& config) {
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

void DomainParticipant::add_reader(const Guid& reader) {
  graph_.readers.push_back(reader);
  publish_graph();
}

void DomainParticipant::add_writer(const Guid& writer) {
  graph_.writers.push_back(writer);
  publish_graph();
}

void DomainParticipant::remove_reader(const Guid& reader) {
  std::erase(graph_.readers, reader);
  publish_graph();
}

void DomainParticipant::remove_writer(const Guid& writer) {
  std::erase(graph_.writers, writer);
  publish_graph();
}

}  // namespace cellmirror::dds
