// Fast DDS as a program without the gateway would use it: what the gateway's own path is compared with.
#pragma once

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <functional>
#include <string>
#include <vector>

#include "drivers/dds/process/bytes_type.hpp"

namespace cellmirror::dds::bench {

// One participant on the loopback interface, with one reader and one writer of JointState payloads.
class BareEndpoint final : private eprosima::fastdds::dds::DataReaderListener {
 public:
  using Receive = std::function<void(BareEndpoint&, BytesSample&)>;  // on the library's thread

  // The reader is best effort, the writer reliable, as the gateway's are by default.
  BareEndpoint(int domain, bool shared_memory, const std::string& read_topic, const std::string& write_topic,
               Receive receive);
  ~BareEndpoint() override;
  BareEndpoint(const BareEndpoint&) = delete;
  BareEndpoint& operator=(const BareEndpoint&) = delete;

  bool write(BytesSample& sample) { return writer_->write(&sample); }
  // Both directions.
  [[nodiscard]] bool matched() const;

 private:
  void on_data_available(eprosima::fastdds::dds::DataReader* reader) override;

  Receive receive_;
  BytesSample sample_;
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  eprosima::fastdds::dds::DataReader* reader_ = nullptr;
  eprosima::fastdds::dds::DataWriter* writer_ = nullptr;
};

}  // namespace cellmirror::dds::bench
