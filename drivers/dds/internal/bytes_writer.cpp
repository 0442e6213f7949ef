#include "drivers/dds/internal/bytes_writer.hpp"

#include <fmt/core.h>

#include <fastdds/rtps/common/WriteParams.h>
#include <atomic>
#include <exception>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <mutex>
#include <set>
#include <utility>

#include "drivers/dds/internal/library_guid.hpp"

namespace cellmirror::dds {

namespace {
constexpr int kMaxDepth = 400;  // the library's default of max_samples_per_instance
}

class BytesWriter::Listener final : public eprosima::fastdds::dds::DataWriterListener {
 public:
  void on_publication_matched(eprosima::fastdds::dds::DataWriter* /*writer*/,
                              const eprosima::fastdds::dds::PublicationMatchedStatus& status) override {
    matched_.store(status.current_count, std::memory_order_relaxed);
    const bool matched = status.current_count_change > 0;
    const Guid reader = guid_of(eprosima::fastrtps::rtps::iHandle2GUID(status.last_subscription_handle));
    const std::scoped_lock lock(mutex_);
    if (matched) {
      readers_.insert(reader);
    } else {
      readers_.erase(reader);
    }
    if (call_) call_(reader, matched);
  }
  void set_call(OnReader call) {
    const std::scoped_lock lock(mutex_);
    call_ = std::move(call);
    if (!call_) return;
    for (const Guid& reader : readers_) call_(reader, true);
  }
  [[nodiscard]] int matched() const { return matched_.load(std::memory_order_relaxed); }

 private:
  std::atomic<int> matched_{0};
  std::mutex mutex_;  // also while the call runs
  std::set<Guid> readers_;
  OnReader call_;
};

BytesWriter::BytesWriter(std::shared_ptr<Participant> participant)
    : participant_(std::move(participant)), listener_(std::make_unique<Listener>()) {}

Result<std::unique_ptr<BytesWriter>> BytesWriter::make(const std::shared_ptr<Participant>& participant,
                                                       const EndpointConfig& config) {
  if (config.depth < 1 || config.depth > kMaxDepth) {
    return fail(fmt::format("a history of {} samples for topic {}", config.depth, config.topic),
                fmt::format("use 1 to {}", kMaxDepth));
  }
  std::unique_ptr<BytesWriter> made(new BytesWriter(participant));
  const auto writer = participant->add_writer(config, made->listener_.get());
  if (!writer) return std::unexpected(writer.error());
  made->writer_ = *writer;
  return made;
}

BytesWriter::~BytesWriter() {
  if (writer_ != nullptr) participant_->remove(writer_);
}

bool BytesWriter::write() {
  try {
    return writer_->write(&sample_);
  } catch (const std::exception&) {
    return false;
  }
}

bool BytesWriter::write_reply(const SampleName& request) {
  eprosima::fastrtps::rtps::WriteParams parameters;
  auto& identity = parameters.related_sample_identity();
  std::size_t at = 0;
  for (auto& byte : identity.writer_guid().guidPrefix.value) byte = request.guid[at++];
  for (auto& byte : identity.writer_guid().entityId.value) byte = request.guid[at++];
  identity.sequence_number() = eprosima::fastrtps::rtps::SequenceNumber_t(static_cast<std::uint64_t>(request.number));
  try {
    return writer_->write(&sample_, parameters);
  } catch (const std::exception&) {
    return false;
  }
}

bool BytesWriter::all_confirmed() const {
  return writer_->wait_for_acknowledgments(eprosima::fastrtps::Duration_t{0, 0}) ==
         eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK;
}

int BytesWriter::matched_readers() const { return listener_->matched(); }

void BytesWriter::on_reader(OnReader call) { listener_->set_call(std::move(call)); }

}  // namespace cellmirror::dds
