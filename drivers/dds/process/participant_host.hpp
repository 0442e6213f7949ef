// The participant of this process and its endpoints, as cellmirror asks for them.
#pragma once

#include <cstdint>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "drivers/dds/message/dds_message.hpp"
#include "drivers/dds/process/event_sender.hpp"

namespace eprosima::fastdds::dds {
class DomainParticipant;
class DomainParticipantFactory;
class Publisher;
class Subscriber;
class Topic;
}  // namespace eprosima::fastdds::dds

namespace cellmirror::dds {

class ReaderEndpoint;
class WriterEndpoint;

// One thread. The library calls the discovery functions on its own threads; they only send events.
class ParticipantHost final : private eprosima::fastdds::dds::DomainParticipantListener {
 public:
  explicit ParticipantHost(EventSender& sender);
  ~ParticipantHost() override;
  ParticipantHost(const ParticipantHost&) = delete;
  ParticipantHost& operator=(const ParticipantHost&) = delete;

  // To be called once, first. Returns false if the library refuses the participant; that is reported.
  bool open(const OpenParticipant& wanted);
  void add(const AddEndpoint& wanted);
  void remove(std::uint32_t id);
  void write(const WriteSample& sample, std::span<const std::byte> payload);

 private:
  struct Group {
    eprosima::fastdds::dds::Publisher* publisher = nullptr;
    eprosima::fastdds::dds::Subscriber* subscriber = nullptr;
  };
  void on_publisher_discovery(eprosima::fastdds::dds::DomainParticipant* participant,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) override;
  void on_subscriber_discovery(eprosima::fastdds::dds::DomainParticipant* participant,
                               eprosima::fastrtps::rtps::ReaderDiscoveryInfo&& info) override;
  // Returns the reason of a refusal, for the user; empty if there was none.
  [[nodiscard]] std::string add_or_say_why(const AddEndpoint& wanted, Guid& guid);
  [[nodiscard]] eprosima::fastdds::dds::Topic* topic(const AddEndpoint& wanted, std::string& why);
  [[nodiscard]] Group& group(const std::string& partition);
  void announce(const Guid& peer, bool gone, const std::vector<std::uint8_t>& user_data);

  EventSender& sender_;
  DdsLink link_ = DdsLink::lan;
  std::shared_ptr<eprosima::fastdds::dds::DomainParticipantFactory> factory_;  // outlives the participant
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  std::map<std::string, Group> groups_;  // by partition
  // To be cleared before the participant is deleted: the library uses their listeners until then.
  std::map<std::uint32_t, std::unique_ptr<ReaderEndpoint>> readers_;
  std::map<std::uint32_t, std::unique_ptr<WriterEndpoint>> writers_;
};

}  // namespace cellmirror::dds
