#include "bare_fastdds.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>

#include <memory>
#include <utility>

#include "drivers/dds/ros2_messages.hpp"

namespace cellmirror::dds::bench {

namespace {

namespace fd = eprosima::fastdds::dds;
namespace rtps = eprosima::fastdds::rtps;

fd::DomainParticipantQos participant_qos(bool shared_memory) {
  fd::DomainParticipantQos qos;
  qos.transport().use_builtin_transports = false;
  auto udp = std::make_shared<rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.emplace_back("127.0.0.1");
  udp->maxInitialPeersRange = 10;
  qos.transport().user_transports.push_back(udp);
  if (shared_memory) qos.transport().user_transports.push_back(std::make_shared<rtps::SharedMemTransportDescriptor>());
  eprosima::fastrtps::rtps::Locator_t peer;
  peer.kind = LOCATOR_KIND_UDPv4;
  eprosima::fastrtps::rtps::IPLocator::setIPv4(peer, "127.0.0.1");
  qos.wire_protocol().builtin.initialPeersList.push_back(peer);
  return qos;
}

fd::Topic* make_topic(fd::DomainParticipant* participant, const std::string& name) {
  return participant->create_topic(name, std::string(kJointStateType), fd::TopicQos{});
}

}  // namespace

BareEndpoint::BareEndpoint(int domain, bool shared_memory, const std::string& read_topic,
                           const std::string& write_topic, Receive receive)
    : receive_(std::move(receive)) {
  participant_ = fd::DomainParticipantFactory::get_instance()->create_participant(static_cast<fd::DomainId_t>(domain),
                                                                                  participant_qos(shared_memory));
  fd::TypeSupport(new BytesType(std::string(kJointStateType))).register_type(participant_);

  fd::DataWriterQos writer_qos;
  writer_qos.reliability().kind = fd::RELIABLE_RELIABILITY_QOS;
  writer_qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  writer_ = participant_->create_publisher(fd::PublisherQos{})
                ->create_datawriter(make_topic(participant_, write_topic), writer_qos);
  fd::DataReaderQos reader_qos;
  reader_qos.reliability().kind = fd::BEST_EFFORT_RELIABILITY_QOS;
  reader_qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  reader_ = participant_->create_subscriber(fd::SubscriberQos{})
                ->create_datareader(make_topic(participant_, read_topic), reader_qos, this);
}

BareEndpoint::~BareEndpoint() {
  participant_->delete_contained_entities();
  fd::DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

bool BareEndpoint::matched() const {
  fd::PublicationMatchedStatus readers;
  fd::SubscriptionMatchedStatus writers;
  writer_->get_publication_matched_status(readers);
  reader_->get_subscription_matched_status(writers);
  return readers.current_count > 0 && writers.current_count > 0;
}

void BareEndpoint::on_data_available(fd::DataReader* reader) {
  fd::SampleInfo info;
  while (reader->take_next_sample(&sample_, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
    if (info.valid_data) receive_(*this, sample_);
  }
}

}  // namespace cellmirror::dds::bench
