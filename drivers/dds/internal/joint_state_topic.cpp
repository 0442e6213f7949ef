#include "drivers/dds/internal/joint_state_topic.hpp"

#include <exception>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <map>
#include <tuple>
#include <utility>

#include "drivers/dds/internal/bytes_type.hpp"
#include "drivers/dds/ros2_messages.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::dds {

namespace {

namespace fd = eprosima::fastdds::dds;

// Samples are taken as they come; this many may wait where a burst meets a busy machine.
constexpr int kReaderDepth = 256;

// FNV-1a of a publisher's 16-byte GUID: an identity for gap counting. Zero means "unknown" to the router.
std::uint64_t publisher_id(const fd::InstanceHandle_t& handle) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (std::size_t i = 0; i < 16; ++i) hash = (hash ^ handle.value[i]) * 0x100000001b3U;
  return hash == 0 ? 1 : hash;
}

WriterGuid guid_of(const fd::InstanceHandle_t& handle) {
  WriterGuid guid;
  for (std::size_t i = 0; i < guid.size(); ++i) guid[i] = handle.value[i];
  return guid;
}

}  // namespace

JointStateTopic::JointStateTopic(std::shared_ptr<Participant> participant, const Clock& clock)
    : participant_(std::move(participant)), clock_(clock) {}

Result<std::shared_ptr<JointStateTopic>> JointStateTopic::shared(const DdsStreamConfig& config, const Clock& clock) {
  static std::mutex mutex;
  static std::map<std::tuple<int, std::string, DdsSecurityConfig, std::string, std::string, bool, const Clock*>,
                  std::weak_ptr<JointStateTopic>>
      topics;
  const std::scoped_lock lock(mutex);
  auto& entry = topics[{config.domain, config.interface_address, config.security, config.partition, config.topic,
                        config.reliable, &clock}];
  if (auto existing = entry.lock()) return existing;
  auto participant = Participant::shared(config.domain, config.interface_address, config.security, config.partition);
  if (!participant) return std::unexpected(participant.error());
  std::shared_ptr<JointStateTopic> made(new JointStateTopic(*participant, clock));
  const auto reader =
      (*participant)->add_reader({config.topic, kJointStateType, config.reliable, kReaderDepth}, made.get());
  if (!reader) return std::unexpected(reader.error());
  made->reader_ = *reader;
  entry = made;
  return made;
}

JointStateTopic::~JointStateTopic() {
  if (reader_ != nullptr) participant_->remove(reader_);
}

void JointStateTopic::add(RobotFeed& feed, JointSampleSink& sink) {
  const std::scoped_lock lock(mutex_);
  router_.add(feed, sink);
}

void JointStateTopic::remove(RobotFeed& feed) {
  const std::scoped_lock lock(mutex_);
  router_.remove(feed);
}

void JointStateTopic::on_data_available(fd::DataReader* reader) {
  // Our lock is not held while the library takes its own, which it may hold already when it calls us.
  static thread_local BytesSample sample;
  try {
    fd::SampleInfo info;
    while (reader->take_next_sample(&sample, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;  // a publisher that leaves
      const Timestamp now = clock_.now();
      messages_.fetch_add(1, std::memory_order_relaxed);
      const std::scoped_lock lock(mutex_);
      const MessageOrigin origin{publisher_id(info.publication_handle),
                                 info.sample_identity.sequence_number().to64long(), guid_of(info.publication_handle)};
      if (sample.received > sample.payload.size()) {
        router_.refuse_too_long(sample.received, kMaxPayloadBytes, origin);
      } else {
        router_.accept(sample.payload, now, origin);
      }
    }
  } catch (const std::exception& error) {
    log_warning("dds.reader", "a sample could not be taken: {}", error.what());
  }
}

void JointStateTopic::on_subscription_matched(fd::DataReader*, const fd::SubscriptionMatchedStatus& status) {
  publishers_.store(status.current_count, std::memory_order_relaxed);
  if (status.current_count_change >= 0) return;
  const std::scoped_lock lock(mutex_);
  router_.forget(publisher_id(status.last_publication_handle));
}

void JointStateTopic::on_requested_incompatible_qos(fd::DataReader*, const fd::RequestedIncompatibleQosStatus& status) {
  incompatible_.store(static_cast<std::uint64_t>(status.total_count), std::memory_order_relaxed);
}

}  // namespace cellmirror::dds
