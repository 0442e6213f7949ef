// Endpoints on the process's DDS participants.
#pragma once

#include <memory>
#include <string>

#include "drivers/dds/internal/domain_participant.hpp"
#include "drivers/dds/internal/endpoint_config.hpp"
#include "drivers/dds/internal/participant_qos.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace eprosima::fastdds::dds {
class DataReader;
class DataReaderListener;
class DataWriterListener;
class Subscriber;
}  // namespace eprosima::fastdds::dds

namespace cellmirror::dds {

// One for each domain, interface, security and partition in use; lives as long as it is referenced. Any thread.
class Participant {
 public:
  // `interface_address`: an IPv4 address of this machine; nothing leaves by other interfaces. `security`: absolute
  // paths; where it is enabled, peers that do not prove their identity are not seen. `partition`: its endpoints meet
  // only those in the same one; empty: those in none, as all of ROS 2.
  [[nodiscard]] static Result<std::shared_ptr<Participant>> shared(int domain, const std::string& interface_address,
                                                                   const DdsSecurityConfig& security,
                                                                   const std::string& partition = {});
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
  [[nodiscard]] const ServiceClients& clients() const { return of_->clients(); }

 private:
  explicit Participant(std::shared_ptr<DomainParticipant> of) : of_(std::move(of)) {}
  [[nodiscard]] Result<void> open(const std::string& partition);

  std::shared_ptr<DomainParticipant> of_;
  eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
};

}  // namespace cellmirror::dds
