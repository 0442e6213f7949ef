// Peers that use Fast DDS in other ways than we do, and what we leave on the machine.
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/types/DynamicDataFactory.h>
#include <fastrtps/types/DynamicDataPtr.h>
#include <fastrtps/types/DynamicPubSubType.h>
#include <fastrtps/types/DynamicTypeBuilderFactory.h>
#include <fastrtps/types/DynamicTypeBuilderPtr.h>
#include <gtest/gtest.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>

#include <filesystem>
#include <string>

#include "drivers/dds/dds_output.hpp"
#include "drivers/dds/dds_stream.hpp"
#include "drivers/dds/ros2_messages.hpp"
#include "own_network.hpp"
#include "waiting.hpp"

namespace cellmirror::dds::test {
namespace {

namespace fd = eprosima::fastdds::dds;
namespace types = eprosima::fastrtps::types;

DdsStreamConfig one_joint(int domain) {
  DdsStreamConfig config;
  config.domain = domain;
  config.joints = {{"a", 0, 1.0, 0.0}};
  return config;
}

// Announces type information, and a type that is not ROS 2's.
class DescribedPeer {
 public:
  explicit DescribedPeer(int domain) {
    auto* builders = types::DynamicTypeBuilderFactory::get_instance();
    const types::DynamicTypeBuilder_ptr builder = builders->create_struct_builder();
    builder->add_member(0, "x", builders->create_int32_type());
    builder->set_name(std::string(kJointStateType));
    const types::DynamicType_ptr type = builder->build();
    fd::TypeSupport support(new types::DynamicPubSubType(type));
    support->auto_fill_type_information(true);
    support->auto_fill_type_object(true);

    fd::DomainParticipantQos qos;
    auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList.emplace_back("127.0.0.1");
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(udp);
    participant_ =
        fd::DomainParticipantFactory::get_instance()->create_participant(static_cast<fd::DomainId_t>(domain), qos);
    support.register_type(participant_);
    fd::Topic* topic = participant_->create_topic("rt/joint_states", std::string(kJointStateType), fd::TopicQos{});
    writer_ = participant_->create_publisher(fd::PublisherQos{})->create_datawriter(topic, fd::DataWriterQos{});
    data_ = types::DynamicDataFactory::get_instance()->create_data(type);
    data_->set_int32_value(7, 0);
  }
  ~DescribedPeer() {
    participant_->delete_contained_entities();
    fd::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  DescribedPeer(const DescribedPeer&) = delete;
  DescribedPeer& operator=(const DescribedPeer&) = delete;
  void write() { writer_->write(data_.get()); }

 private:
  fd::DomainParticipant* participant_ = nullptr;
  fd::DataWriter* writer_ = nullptr;
  types::DynamicData_ptr data_;
};

TEST(DdsPeers, OneThatAnnouncesTypeInformationIsReadAndRefusedForWhatItSends) {
  const int domain = test_domain(3);
  SystemClock clock;
  CollectingSink sink;
  const auto sut = make_dds_stream(one_joint(domain), clock).value();
  ASSERT_TRUE(sut->open(sink).has_value());
  DescribedPeer peer(domain);
  EXPECT_TRUE(eventually([&] {
    peer.write();
    return sut->status().rejected > 0;
  })) << sut->status().condition;
  EXPECT_EQ(sink.size(), 0U);
}

TEST(DdsFootprint, NothingIsKeptInSharedMemoryThatAKillCouldLeaveBehind) {
  const int domain = test_domain(7);
  SystemClock clock;
  CollectingSink sink;
  const auto stream = make_dds_stream(one_joint(domain), clock).value();
  ASSERT_TRUE(stream->open(sink).has_value());
  DdsOutputConfig config;
  config.domain = domain;
  const auto output = make_dds_output(config).value();
  // Fast DDS's shared memory transport names its files after the domain's ports.
  for (int port = 7400 + 250 * domain; port < 7400 + 250 * (domain + 1); ++port) {
    EXPECT_FALSE(std::filesystem::exists("/dev/shm/fastrtps_port" + std::to_string(port)));
  }
}

}  // namespace
}  // namespace cellmirror::dds::test
