// A reader and a writer of the DDS library. Their events are sent to cellmirror.
#pragma once

#include <cstdint>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include "drivers/dds/message/dds_message.hpp"
#include "drivers/dds/process/bytes_sample.hpp"
#include "drivers/dds/process/event_sender.hpp"

namespace cellmirror::dds {

// The library calls the private functions on its own threads.
class ReaderEndpoint final : private eprosima::fastdds::dds::DataReaderListener {
 public:
  ReaderEndpoint(std::uint32_t id, EventSender& sender) : id_(id), sender_(sender) {}
  ~ReaderEndpoint() override;
  ReaderEndpoint(const ReaderEndpoint&) = delete;
  ReaderEndpoint& operator=(const ReaderEndpoint&) = delete;

  // Returns false if the library refuses the reader. The subscriber has to outlive the object.
  bool open(eprosima::fastdds::dds::Subscriber& subscriber, eprosima::fastdds::dds::Topic& topic,
            const AddEndpoint& wanted);
  [[nodiscard]] Guid guid() const;

 private:
  void on_data_available(eprosima::fastdds::dds::DataReader* reader) override;
  void on_subscription_matched(eprosima::fastdds::dds::DataReader* reader,
                               const eprosima::fastdds::dds::SubscriptionMatchedStatus& status) override;
  void on_requested_incompatible_qos(eprosima::fastdds::dds::DataReader* reader,
                                     const eprosima::fastdds::dds::RequestedIncompatibleQosStatus& status) override;

  const std::uint32_t id_;
  EventSender& sender_;
  eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
  eprosima::fastdds::dds::DataReader* reader_ = nullptr;
};

// One thread writes.
class WriterEndpoint final : private eprosima::fastdds::dds::DataWriterListener {
 public:
  WriterEndpoint(std::uint32_t id, EventSender& sender) : id_(id), sender_(sender) {}
  ~WriterEndpoint() override;
  WriterEndpoint(const WriterEndpoint&) = delete;
  WriterEndpoint& operator=(const WriterEndpoint&) = delete;

  // See ReaderEndpoint::open().
  bool open(eprosima::fastdds::dds::Publisher& publisher, eprosima::fastdds::dds::Topic& topic,
            const AddEndpoint& wanted, DdsLink link);
  [[nodiscard]] Guid guid() const;
  void write(const WriteSample& sample, std::span<const std::byte> payload);

 private:
  void on_publication_matched(eprosima::fastdds::dds::DataWriter* writer,
                              const eprosima::fastdds::dds::PublicationMatchedStatus& status) override;
  [[nodiscard]] bool all_confirmed() const;
  void count_overwritten();

  const std::uint32_t id_;
  EventSender& sender_;
  bool counts_overwritten_ = false;
  int depth_ = 1;
  int unconfirmed_ = 0;
  std::uint64_t dropped_ = 0;
  eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
  eprosima::fastdds::dds::DataWriter* writer_ = nullptr;
  BytesSample sample_;
};

}  // namespace cellmirror::dds
