// Which writers of other participants are those of clients that put a header in front of their requests. Includes the
// library's headers.
#pragma once

#include <atomic>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <mutex>

#include "drivers/dds/service_mapping.hpp"

namespace cellmirror::dds {

// Outlives its participant. The library tells it of a writer before it gives samples of that writer to readers.
class ServiceClients final : public eprosima::fastdds::dds::DomainParticipantListener {
 public:
  void on_publisher_discovery(eprosima::fastdds::dds::DomainParticipant* participant,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) override;
  // Any thread.
  [[nodiscard]] bool announces_client(const Guid& writer) const;

 private:
  mutable std::mutex mutex_;  // nothing of the library is called while it is held
  ClientWriters writers_;
  std::atomic<bool> warned_{false};
};

}  // namespace cellmirror::dds
