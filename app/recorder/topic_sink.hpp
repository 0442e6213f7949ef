// Who takes the messages of topics: a recording, or the clients that watch live.
#pragma once

#include <cstdint>

#include "app/recorder/topic.hpp"
#include "ipc/record/layout.hpp"

namespace cellmirror::app {

// Any thread but the tick's; nothing waits.
class TopicSink {
 public:
  virtual ~TopicSink() = default;
  // Both times: nanoseconds since 1970, UTC.
  virtual void put(const TopicPtr& topic, std::int64_t log_time_ns, std::int64_t publish_time_ns, mcap::View data) = 0;
  // Messages of the topic that were never made.
  virtual void count_missed(const TopicPtr& topic, std::uint64_t messages) = 0;
  // Whether messages of the topic are to be made.
  [[nodiscard]] virtual bool wants(const Topic& topic) const = 0;
  // The rate of robot states that is wanted; 0: nothing is.
  [[nodiscard]] virtual double rate_hz() const = 0;
};

}  // namespace cellmirror::app
