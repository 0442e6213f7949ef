#include "drivers/dds/process/participant_host.hpp"

#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>

#include <exception>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <utility>

#include "drivers/dds/process/bytes_type.hpp"
#include "drivers/dds/process/endpoints.hpp"
#include "drivers/dds/process/library_guid.hpp"
#include "drivers/dds/process/participant_qos.hpp"

namespace cellmirror::dds {

namespace {

namespace fd = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

}  // namespace

ParticipantHost::ParticipantHost(EventSender& sender)
    : sender_(sender), factory_(fd::DomainParticipantFactory::get_shared_instance()) {}

ParticipantHost::~ParticipantHost() {
  if (participant_ == nullptr) return;
  readers_.clear();
  writers_.clear();
  participant_->delete_contained_entities();
  factory_->delete_participant(participant_);
}

bool ParticipantHost::open(const OpenParticipant& wanted) {
  std::string why;
  try {
    link_ = wanted.network.link;
    participant_ = factory_->create_participant(static_cast<fd::DomainId_t>(wanted.domain), participant_qos(wanted),
                                                this, fd::StatusMask::none());
  } catch (const std::exception& error) {
    why = error.what();
  }
  if (participant_ == nullptr) {
    sender_.send(ParticipantRefused{why});
    return false;
  }
  sender_.send(ParticipantOpened{guid_of(participant_->guid())});
  return true;
}

fd::Topic* ParticipantHost::topic(const AddEndpoint& wanted, std::string& why) {
  if (fd::TopicDescription* existing = participant_->lookup_topicdescription(wanted.topic)) {
    if (existing->get_type_name() == wanted.type) return static_cast<fd::Topic*>(existing);
    why = "topic " + wanted.topic + " carries " + existing->get_type_name() + " already, not " + wanted.type;
    return nullptr;
  }
  fd::TypeSupport support(new BytesType(wanted.type));
  support.register_type(participant_);
  fd::Topic* made = participant_->create_topic(wanted.topic, wanted.type, fd::TopicQos{});
  if (made == nullptr) why = "DDS refused the topic " + wanted.topic;
  return made;
}

ParticipantHost::Group& ParticipantHost::group(const std::string& partition) {
  const auto [found, made] = groups_.try_emplace(partition);
  if (!made) return found->second;
  fd::PublisherQos publishers;
  fd::SubscriberQos subscribers;
  if (!partition.empty()) {
    publishers.partition().push_back(partition.c_str());
    subscribers.partition().push_back(partition.c_str());
  }
  found->second = {participant_->create_publisher(publishers), participant_->create_subscriber(subscribers)};
  return found->second;
}

std::string ParticipantHost::add_or_say_why(const AddEndpoint& wanted, Guid& guid) {
  std::string why;
  fd::Topic* const of_topic = topic(wanted, why);
  if (of_topic == nullptr) return why;
  const Group& of_partition = group(wanted.partition);
  if (of_partition.publisher == nullptr || of_partition.subscriber == nullptr)
    return "DDS refused a publisher or subscriber";
  if (wanted.writer) {
    auto made = std::make_unique<WriterEndpoint>(wanted.id, sender_);
    if (!made->open(*of_partition.publisher, *of_topic, wanted, link_))
      return "DDS refused a writer of " + wanted.topic;
    guid = made->guid();
    writers_[wanted.id] = std::move(made);
  } else {
    auto made = std::make_unique<ReaderEndpoint>(wanted.id, sender_);
    if (!made->open(*of_partition.subscriber, *of_topic, wanted)) return "DDS refused a reader of " + wanted.topic;
    guid = made->guid();
    readers_[wanted.id] = std::move(made);
  }
  return {};
}

void ParticipantHost::add(const AddEndpoint& wanted) {
  Guid guid{};
  std::string why;
  try {
    why = add_or_say_why(wanted, guid);
  } catch (const std::exception& error) {
    why = error.what();
  }
  if (why.empty()) {
    sender_.send(EndpointAdded{wanted.id, guid});
  } else {
    sender_.send(EndpointRefused{wanted.id, why});
  }
}

void ParticipantHost::remove(std::uint32_t id) {
  readers_.erase(id);
  writers_.erase(id);
}

void ParticipantHost::write(const WriteSample& sample, std::span<const std::byte> payload) {
  const auto found = writers_.find(sample.id);
  if (found != writers_.end()) found->second->write(sample, payload);
}

void ParticipantHost::announce(const Guid& peer, bool gone, const std::vector<std::uint8_t>& user_data) {
  if (user_data.empty() && !gone) return;
  PeerAnnounced event{peer, gone, {}};
  if (user_data.size() <= kMaxUserData) event.user_data.assign(user_data.begin(), user_data.end());
  sender_.send(std::move(event));
}

void ParticipantHost::on_publisher_discovery(fd::DomainParticipant* /*participant*/, rtps::WriterDiscoveryInfo&& info) {
  announce(guid_of(info.info.guid()), info.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER,
           info.info.m_qos.m_userData.getValue());
}

void ParticipantHost::on_subscriber_discovery(fd::DomainParticipant* /*participant*/,
                                              rtps::ReaderDiscoveryInfo&& info) {
  announce(guid_of(info.info.guid()), info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER,
           info.info.m_qos.m_userData.getValue());
}

}  // namespace cellmirror::dds
