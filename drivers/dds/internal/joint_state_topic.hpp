// One DDS reader of JointState and the robots that share it.
#pragma once

#include <atomic>
#include <cstdint>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <memory>
#include <mutex>
#include <string>

#include "drivers/dds/internal/participant.hpp"
#include "drivers/dds/joint_state_router.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::dds {

struct TopicStatus {
  int publishers = 0;              // matched now
  std::uint64_t messages = 0;      // of any content
  std::uint64_t incompatible = 0;  // publishers seen that do not offer what we ask for
};

// Samples are taken on the thread of the DDS library that received them, without a hand-over. The mutex is among those
// threads, where several serve one reader, and add() and remove() of the cell's owner; no status takes it.
class JointStateTopic final : private eprosima::fastdds::dds::DataReaderListener {
 public:
  // The one for this domain, interface, topic, reliability and clock; lives as long as it is referred to. Any thread.
  [[nodiscard]] static Result<std::shared_ptr<JointStateTopic>> shared(const DdsStreamConfig& config,
                                                                       const Clock& clock);
  ~JointStateTopic() override;
  JointStateTopic(const JointStateTopic&) = delete;
  JointStateTopic& operator=(const JointStateTopic&) = delete;

  void add(RobotFeed& feed, JointSampleSink& sink);
  // After it returns nothing is pushed for this feed any more.
  void remove(RobotFeed& feed);
  // Any thread; takes no lock. The counters are not taken at one instant.
  [[nodiscard]] TopicStatus status() const {
    return {publishers_.load(std::memory_order_relaxed), messages_.load(std::memory_order_relaxed),
            incompatible_.load(std::memory_order_relaxed)};
  }

 private:
  JointStateTopic(std::shared_ptr<Participant> participant, const Clock& clock);
  void on_data_available(eprosima::fastdds::dds::DataReader* reader) override;
  void on_subscription_matched(eprosima::fastdds::dds::DataReader* reader,
                               const eprosima::fastdds::dds::SubscriptionMatchedStatus& status) override;
  void on_requested_incompatible_qos(eprosima::fastdds::dds::DataReader* reader,
                                     const eprosima::fastdds::dds::RequestedIncompatibleQosStatus& status) override;

  std::shared_ptr<Participant> participant_;
  const Clock& clock_;
  eprosima::fastdds::dds::DataReader* reader_ = nullptr;
  std::mutex mutex_;
  JointStateRouter router_;  // under the mutex
  // Relaxed: each publishes nothing but itself.
  std::atomic<int> publishers_{0};
  std::atomic<std::uint64_t> messages_{0};
  std::atomic<std::uint64_t> incompatible_{0};
};

}  // namespace cellmirror::dds
