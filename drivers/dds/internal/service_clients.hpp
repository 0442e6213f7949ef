// Which readers and writers of other participants are those of clients of services (service_mapping.hpp). Includes the
// library's headers.
#pragma once

#include <atomic>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <mutex>
#include <span>
#include <string_view>

#include "drivers/dds/service_mapping.hpp"

namespace cellmirror::dds {

// Outlives its participant. The library tells it of an endpoint before it matches that endpoint with ours.
class ServiceClients final : public eprosima::fastdds::dds::DomainParticipantListener {
 public:
  void on_publisher_discovery(eprosima::fastdds::dds::DomainParticipant* participant,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) override;
  void on_subscriber_discovery(eprosima::fastdds::dds::DomainParticipant* participant,
                               eprosima::fastrtps::rtps::ReaderDiscoveryInfo&& info) override;
  // As ClientEndpoints. Any thread.
  [[nodiscard]] bool contains(const Guid& endpoint) const;
  [[nodiscard]] bool reaches(const RequestName& to, std::span<const Guid> readers) const;

 private:
  void note(const Guid& endpoint, std::string_view user_data, bool gone);

  mutable std::mutex mutex_;  // nothing of the library is called while it is held
  ClientEndpoints endpoints_;
  std::atomic<bool> warned_{false};
};

}  // namespace cellmirror::dds
