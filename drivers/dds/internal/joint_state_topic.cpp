#include "drivers/dds/internal/joint_state_topic.hpp"

#include <map>
#include <tuple>
#include <utility>

#include "drivers/dds/ros2_messages.hpp"

namespace cellmirror::dds {

namespace {

// Samples are taken as they come; this many may wait where a burst meets a busy machine.
constexpr int kReaderDepth = 256;

// FNV-1a of a publisher's 16-byte GUID: an identity for gap counting. Zero means "unknown" to the router.
std::uint64_t publisher_id(const Guid& guid) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const std::uint8_t byte : guid) hash = (hash ^ byte) * 0x100000001b3U;
  return hash == 0 ? 1 : hash;
}

}  // namespace

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
  std::shared_ptr<JointStateTopic> made(new JointStateTopic(clock));
  JointStateTopic* const self = made.get();
  auto reader = BytesReader::make(
      *participant, {config.topic, kJointStateType, config.reliable, kReaderDepth},
      [self](const ReceivedSample& sample) { self->take(sample); },
      [self](const Guid& publisher) { self->forget(publisher); });
  if (!reader) return std::unexpected(reader.error());
  made->reader_ = std::move(*reader);
  entry = made;
  return made;
}

void JointStateTopic::add(RobotFeed& feed, JointSampleSink& sink) {
  const std::scoped_lock lock(mutex_);
  router_.add(feed, sink);
}

void JointStateTopic::remove(RobotFeed& feed) {
  const std::scoped_lock lock(mutex_);
  router_.remove(feed);
}

void JointStateTopic::take(const ReceivedSample& sample) {
  const Timestamp received = clock_.now() - sample.age;
  const MessageOrigin origin{publisher_id(sample.name.guid), static_cast<std::uint64_t>(sample.name.number),
                             sample.name.guid};
  const std::scoped_lock lock(mutex_);
  if (sample.received > sample.payload.size()) {
    router_.refuse_too_long(sample.received, kMaxPayloadBytes, origin);
  } else {
    router_.accept(sample.payload, received, origin);
  }
}

void JointStateTopic::forget(const Guid& publisher) {
  const std::scoped_lock lock(mutex_);
  router_.forget(publisher_id(publisher));
}

}  // namespace cellmirror::dds
