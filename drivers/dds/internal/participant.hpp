// The process's DDS participants, and endpoints on them.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "drivers/dds/ros_graph.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/ros_presence.hpp"
#include "rt_core/ports/stream_config.hpp"

// The library's headers take seconds to compile: only sources that call it include them.
namespace eprosima::fastdds::dds {
class DataReader;
class DataReaderListener;
class DataWriter;
class DataWriterListener;
class DomainParticipant;
class DomainParticipantFactory;
class Publisher;
class Subscriber;
class Topic;
}  // namespace eprosima::fastdds::dds

namespace cellmirror::dds {

struct EndpointConfig {
  std::string topic;
  std::string_view type;
  bool reliable = false;
  int depth = 1;
  bool large = false;            // a writer's samples are larger than a datagram: sent by a thread of the library's
  bool transient_local = false;  // a writer gives its history to readers that come later
};

[[nodiscard]] Result<void> check_domain(int domain);
[[nodiscard]] Result<void> check_topic(std::string_view topic);

// One for each domain, interface and security in use; lives as long as it is referenced. Any thread.
class Participant {
 public:
  // `interface_address`: an IPv4 address of this machine; nothing leaves by other interfaces. `security`: absolute
  // paths; where it is enabled, peers that do not prove their identity are not seen.
  [[nodiscard]] static Result<std::shared_ptr<Participant>> shared(int domain, const std::string& interface_address,
                                                                   const DdsSecurityConfig& security);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  // The listener outlives the endpoint, which is deleted by remove() before the participant goes.
  [[nodiscard]] Result<eprosima::fastdds::dds::DataReader*> add_reader(
      const EndpointConfig& config, eprosima::fastdds::dds::DataReaderListener* listener);
  [[nodiscard]] Result<eprosima::fastdds::dds::DataWriter*> add_writer(
      const EndpointConfig& config, eprosima::fastdds::dds::DataWriterListener* listener);
  void remove(eprosima::fastdds::dds::DataReader* reader);
  void remove(eprosima::fastdds::dds::DataWriter* writer);

 private:
  Participant(std::shared_ptr<eprosima::fastdds::dds::DomainParticipantFactory> factory, RosPresence presence);
  // Makes the writer of what nodes there are, where the presence says for whom.
  [[nodiscard]] Result<void> open_graph();
  void publish_graph();
  [[nodiscard]] Result<eprosima::fastdds::dds::DataWriter*> make_writer(
      const EndpointConfig& config, eprosima::fastdds::dds::DataWriterListener* listener);
  [[nodiscard]] Result<eprosima::fastdds::dds::Topic*> topic(const EndpointConfig& config);

  std::shared_ptr<eprosima::fastdds::dds::DomainParticipantFactory> factory_;  // outlives the participant
  std::mutex mutex_;                                                           // making and removing endpoints
  const RosPresence presence_;
  RosGraph graph_;                                              // under the mutex
  eprosima::fastdds::dds::DataWriter* graph_writer_ = nullptr;  // null: nothing is published
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
};

}  // namespace cellmirror::dds
