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
    note(guid_of(eprosima::fastrtps::rtps::iHandle2GUID(status.last_subscription_handle)),
         status.current_count_change > 0);
    if (status.current_count_change <= 0) return;
    const std::scoped_lock lock(call_mutex_);
    if (call_) call_();
  }
  void set_call(std::function<void()> call) {
    const std::scoped_lock lock(call_mutex_);
    call_ = std::move(call);
  }
  [[nodiscard]] int matched() const { return matched_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::vector<Guid> readers() const {
    const std::scoped_lock lock(readers_mutex_);
    return {readers_.begin(), readers_.end()};
  }

 private:
  void note(const Guid& reader, bool matched) {
    const std::scoped_lock lock(readers_mutex_);
    if (matched) {
      readers_.insert(reader);
    } else {
      readers_.erase(reader);
    }
  }

  std::atomic<int> matched_{0};
  mutable std::mutex readers_mutex_;  // nothing is called while it is held
  std::set<Guid> readers_;
  std::mutex call_mutex_;
  std::function<void()> call_;
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

std::vector<Guid> BytesWriter::readers() const { return listener_->readers(); }

void BytesWriter::on_reader(std::function<void()> call) { listener_->set_call(std::move(call)); }

}  // namespace cellmirror::dds
