#include "drivers/dds/process/endpoints.hpp"

#include <fastdds/rtps/common/WriteParams.h>

#include <algorithm>
#include <ctime>
#include <exception>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/topic/Topic.hpp>

#include "drivers/dds/process/endpoint_qos.hpp"
#include "drivers/dds/process/library_guid.hpp"

namespace cellmirror::dds {

namespace {

namespace fd = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using ReturnCode = eprosima::fastrtps::types::ReturnCode_t;

std::int64_t monotonic_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

ReaderEndpoint::~ReaderEndpoint() {
  if (reader_ != nullptr) subscriber_->delete_datareader(reader_);
}

bool ReaderEndpoint::open(fd::Subscriber& subscriber, fd::Topic& topic, const AddEndpoint& wanted) {
  subscriber_ = &subscriber;
  reader_ = subscriber.create_datareader(&topic, reader_qos(wanted), this);
  return reader_ != nullptr;
}

Guid ReaderEndpoint::guid() const { return guid_of(reader_->guid()); }

void ReaderEndpoint::on_data_available(fd::DataReader* reader) {
  static thread_local BytesSample sample;
  try {
    fd::SampleInfo info;
    while (reader->take_next_sample(&sample, &info) == ReturnCode::RETCODE_OK) {
      if (!info.valid_data) continue;  // a writer that leaves
      SampleReceived event;
      event.id = id_;
      event.taken_ns = monotonic_ns();
      event.writer = guid_of(info.sample_identity.writer_guid());
      event.number = static_cast<std::int64_t>(info.sample_identity.sequence_number().to64long());
      const auto& related = info.related_sample_identity.writer_guid();
      if (related != rtps::GUID_t::unknown()) event.related = guid_of(related);
      event.received = sample.received;
      event.start = sample.start;
      sender_.send_sample(event, sample.payload);
    }
  } catch (const std::exception& error) {
    sender_.send(LibraryLog{true, "reader", error.what()});
  }
}

void ReaderEndpoint::on_subscription_matched(fd::DataReader* /*reader*/, const fd::SubscriptionMatchedStatus& status) {
  sender_.send(PeerMatched{id_, guid_of(rtps::iHandle2GUID(status.last_publication_handle)),
                           status.current_count_change >= 0, status.current_count});
}

void ReaderEndpoint::on_requested_incompatible_qos(fd::DataReader* /*reader*/,
                                                   const fd::RequestedIncompatibleQosStatus& status) {
  sender_.send(PeersIncompatible{id_, static_cast<std::uint64_t>(status.total_count)});
}

WriterEndpoint::~WriterEndpoint() {
  if (writer_ != nullptr) publisher_->delete_datawriter(writer_);
}

bool WriterEndpoint::open(fd::Publisher& publisher, fd::Topic& topic, const AddEndpoint& wanted, DdsLink link) {
  publisher_ = &publisher;
  counts_overwritten_ = wanted.counts_overwritten;
  depth_ = wanted.depth;
  writer_ = publisher.create_datawriter(&topic, writer_qos(wanted, link), this);
  return writer_ != nullptr;
}

Guid WriterEndpoint::guid() const { return guid_of(writer_->guid()); }

bool WriterEndpoint::all_confirmed() const {
  return writer_->wait_for_acknowledgments(eprosima::fastrtps::Duration_t{0, 0}) == ReturnCode::RETCODE_OK;
}

void WriterEndpoint::count_overwritten() {
  if (!counts_overwritten_ || all_confirmed()) {
    unconfirmed_ = 0;
  } else if (unconfirmed_ >= depth_) {
    ++dropped_;
  }
  unconfirmed_ = std::min(unconfirmed_ + 1, depth_);
}

void WriterEndpoint::write(const WriteSample& sample, std::span<const std::byte> payload) {
  const std::uint64_t dropped_before = dropped_;
  sample_.payload.assign(payload.begin(), payload.end());
  count_overwritten();
  bool written = false;
  if (sample.reply) {
    rtps::WriteParams parameters;
    auto& identity = parameters.related_sample_identity();
    identity.writer_guid() = library_guid(sample.request_guid);
    identity.sequence_number() = rtps::SequenceNumber_t(static_cast<std::uint64_t>(sample.request_number));
    written = writer_->write(&sample_, parameters);
  } else {
    written = writer_->write(&sample_);
  }
  if (!written) ++dropped_;
  if (dropped_ != dropped_before) sender_.send(SamplesDropped{id_, dropped_});
}

void WriterEndpoint::on_publication_matched(fd::DataWriter* /*writer*/, const fd::PublicationMatchedStatus& status) {
  sender_.send(PeerMatched{id_, guid_of(rtps::iHandle2GUID(status.last_subscription_handle)),
                           status.current_count_change > 0, status.current_count});
}

}  // namespace cellmirror::dds
