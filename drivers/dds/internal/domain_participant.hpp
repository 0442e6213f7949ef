// The process's DDS participants, and what they show programs of ROS 2 of themselves.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "drivers/dds/internal/endpoint_config.hpp"
#include "drivers/dds/ros_graph.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/dds_network.hpp"
#include "rt_core/ports/ros_presence.hpp"
#include "rt_core/ports/stream_config.hpp"

// The library's headers take seconds to compile: only sources that call it include them.
namespace eprosima::fastdds::dds {
class DataWriter;
class DomainParticipant;
class DomainParticipantFactory;
class Publisher;
class Topic;
}  // namespace eprosima::fastdds::dds

namespace cellmirror::dds {

class ServiceClients;

// One for each domain, interface and security in use; lives as long as it is referenced. Any thread.
class DomainParticipant {
 public:
  [[nodiscard]] static Result<std::shared_ptr<DomainParticipant>> shared(int domain,
                                                                         const std::string& interface_address,
                                                                         const DdsSecurityConfig& security);
  ~DomainParticipant();
  DomainParticipant(const DomainParticipant&) = delete;
  DomainParticipant& operator=(const DomainParticipant&) = delete;

  [[nodiscard]] eprosima::fastdds::dds::DomainParticipant& library() { return *participant_; }
  [[nodiscard]] const RosPresence& presence() const { return presence_; }
  // How samples are sent: over a lossy link in datagrams that need a thread of the library's.
  [[nodiscard]] DdsLink link() const { return network_.link; }
  // Held while endpoints are made and removed, and for what follows.
  [[nodiscard]] std::mutex& mutex() { return mutex_; }
  [[nodiscard]] Result<eprosima::fastdds::dds::Topic*> topic(const EndpointConfig& config);
  [[nodiscard]] const ServiceClients& clients() const { return *clients_; }
  void add_reader(const Guid& reader);
  void add_writer(const Guid& writer);
  void remove_reader(const Guid& reader);
  void remove_writer(const Guid& writer);

 private:
  DomainParticipant(RosPresence presence, DdsNetworkConfig network);
  [[nodiscard]] Result<void> open(int domain, const std::string& address, const DdsSecurityConfig& security);
  // Makes the writer of what nodes there are, where the presence says for whom.
  [[nodiscard]] Result<void> open_graph();
  void publish_graph();

  std::shared_ptr<eprosima::fastdds::dds::DomainParticipantFactory> factory_;  // outlives the participant
  const std::unique_ptr<ServiceClients> clients_;                              // outlives the participant
  std::mutex mutex_;
  const RosPresence presence_;
  const DdsNetworkConfig network_;
  RosGraph graph_;                                                // under the mutex
  eprosima::fastdds::dds::Publisher* graph_publisher_ = nullptr;  // in no partition
  eprosima::fastdds::dds::DataWriter* graph_writer_ = nullptr;    // null: nothing is published
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
};

}  // namespace cellmirror::dds
