#include "drivers/dds/internal/bytes_reader.hpp"

#include <atomic>
#include <exception>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <mutex>
#include <utility>

#include "drivers/dds/internal/bytes_type.hpp"
#include "drivers/dds/internal/library_guid.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::dds {

namespace {

namespace fd = eprosima::fastdds::dds;

}  // namespace

class BytesReader::Listener final : public fd::DataReaderListener {
 public:
  Listener(Receive receive, Gone gone) : receive_(std::move(receive)), gone_(std::move(gone)) {}

  void on_data_available(fd::DataReader* reader) override {
    // Our lock is not held while the library takes its own, which it may hold already when it calls us.
    static thread_local BytesSample sample;
    try {
      fd::SampleInfo info;
      while (reader->take_next_sample(&sample, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
        if (!info.valid_data) continue;  // a writer that leaves
        samples_.fetch_add(1, std::memory_order_relaxed);
        ReceivedSample out;
        out.payload = sample.payload;
        out.received = sample.received;
        out.start = sample.start;
        out.name.guid = guid_of(info.sample_identity.writer_guid());
        out.name.number = static_cast<std::int64_t>(info.sample_identity.sequence_number().to64long());
        const auto& related = info.related_sample_identity.writer_guid();
        if (related != eprosima::fastrtps::rtps::GUID_t::unknown()) out.related_guid = guid_of(related);
        const std::scoped_lock lock(mutex_);
        if (receive_) receive_(out);
      }
    } catch (const std::exception& error) {
      log_warning("dds.reader", "a sample could not be taken: {}", error.what());
    }
  }
  void on_subscription_matched(fd::DataReader* /*reader*/, const fd::SubscriptionMatchedStatus& status) override {
    matched_.store(status.current_count, std::memory_order_relaxed);
    if (status.current_count_change >= 0) return;
    const eprosima::fastrtps::rtps::GUID_t writer =
        eprosima::fastrtps::rtps::iHandle2GUID(status.last_publication_handle);
    const std::scoped_lock lock(mutex_);
    if (gone_) gone_(guid_of(writer));
  }
  void end() {
    const std::scoped_lock lock(mutex_);
    receive_ = nullptr;
    gone_ = nullptr;
  }
  [[nodiscard]] int matched() const { return matched_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t samples() const { return samples_.load(std::memory_order_relaxed); }

 private:
  std::mutex mutex_;
  Receive receive_;  // under the mutex
  Gone gone_;        // likewise
  // Relaxed: each publishes nothing but itself.
  std::atomic<int> matched_{0};
  std::atomic<std::uint64_t> samples_{0};
};

BytesReader::BytesReader(std::shared_ptr<Participant> participant) : participant_(std::move(participant)) {}

Result<std::unique_ptr<BytesReader>> BytesReader::make(const std::shared_ptr<Participant>& participant,
                                                       const EndpointConfig& config, Receive receive, Gone gone) {
  std::unique_ptr<BytesReader> made(new BytesReader(participant));
  made->listener_ = std::make_unique<Listener>(std::move(receive), std::move(gone));
  const auto reader = participant->add_reader(config, made->listener_.get());
  if (!reader) return std::unexpected(reader.error());
  made->reader_ = *reader;
  return made;
}

BytesReader::~BytesReader() {
  if (listener_) listener_->end();
  if (reader_ != nullptr) participant_->remove(reader_);
}

int BytesReader::matched_writers() const { return listener_->matched(); }

std::uint64_t BytesReader::samples() const { return listener_->samples(); }

}  // namespace cellmirror::dds
