// One DDS reader of JointState and the robots that share it.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "drivers/dds/internal/bytes_reader.hpp"
#include "drivers/dds/joint_state_router.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::dds {

struct TopicStatus {
  int publishers = 0;              // matched now
  std::uint64_t messages = 0;      // of any content
  std::uint64_t incompatible = 0;  // publishers seen that do not offer what we ask for
  std::string outage;              // DomainLink::outage()
};

// Samples are decoded and routed on the link's thread. The mutex is among that thread and add() and remove() of the
// cell's owner; no status takes it.
class JointStateTopic final {
 public:
  // The one for this domain, interface, topic, reliability and clock; lives as long as it is referred to. Any thread.
  [[nodiscard]] static Result<std::shared_ptr<JointStateTopic>> shared(const DdsStreamConfig& config,
                                                                       const Clock& clock);
  JointStateTopic(const JointStateTopic&) = delete;
  JointStateTopic& operator=(const JointStateTopic&) = delete;

  void add(RobotFeed& feed, JointSampleSink& sink);
  // After it returns nothing is pushed for this feed any more.
  void remove(RobotFeed& feed);
  // Any thread; does not wait for samples. The counters are not taken at one instant.
  [[nodiscard]] TopicStatus status() const {
    return {reader_->matched_writers(), reader_->samples(), reader_->incompatible(), reader_->outage()};
  }

 private:
  explicit JointStateTopic(const Clock& clock) : clock_(clock) {}
  void take(const ReceivedSample& sample);
  void forget(const Guid& publisher);

  const Clock& clock_;
  std::mutex mutex_;
  JointStateRouter router_;              // under the mutex
  std::unique_ptr<BytesReader> reader_;  // last: it calls the above
};

}  // namespace cellmirror::dds
