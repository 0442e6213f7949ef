// One DDS reader of JointState and the robots that share it.
#pragma once

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

// Samples are taken on the thread of the DDS library that received them, without a hand-over; the mutex makes
// it one at a time also where several such threads serve one reader.
class JointStateTopic final : private eprosima::fastdds::dds::DataReaderListener {
 public:
  // The one for this domain, interface, topic, reliability and clock; lives as long as somebody holds it. Any thread.
  [[nodiscard]] static Result<std::shared_ptr<JointStateTopic>> shared(const DdsStreamConfig& config,
                                                                       const Clock& clock);
  ~JointStateTopic() override;
  JointStateTopic(const JointStateTopic&) = delete;
  JointStateTopic& operator=(const JointStateTopic&) = delete;

  void add(RobotFeed& feed, JointSampleSink& sink);
  // After it returns nothing is pushed for this feed any more.
  void remove(RobotFeed& feed);
  // Held while a feed of this topic is looked at.
  [[nodiscard]] std::unique_lock<std::mutex> lock() const { return std::unique_lock(mutex_); }
  // With the lock held.
  [[nodiscard]] const TopicStatus& status() const { return status_; }

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
  mutable std::mutex mutex_;
  JointStateRouter router_;
  TopicStatus status_;
};

}  // namespace cellmirror::dds
