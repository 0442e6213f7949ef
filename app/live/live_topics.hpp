// Gives the messages of topics to the clients of the Foxglove protocol that subscribe to them.
#pragma once

#include <mutex>

#include "app/recorder/topic_sink.hpp"
#include "ipc/foxglove/topic_feed.hpp"

namespace cellmirror::app {

class LiveTopics final : public TopicSink {
 public:
  static constexpr double kUsualRate_hz = 50;

  // Topics that come seldom or late are there from the start.
  LiveTopics();

  void put(const TopicPtr& topic, std::int64_t log_time_ns, std::int64_t publish_time_ns, mcap::View data) override;
  void count_missed(const TopicPtr& topic, std::uint64_t messages) override;
  [[nodiscard]] bool wants(const Topic& topic) const override;
  // 0 while no client is connected.
  [[nodiscard]] double rate_hz() const override;

  [[nodiscard]] double wanted_rate_hz() const;
  void set_rate_hz(double rate_hz);
  [[nodiscard]] foxglove::TopicFeed& feed() { return feed_; }
  [[nodiscard]] const foxglove::TopicFeed& feed() const { return feed_; }

 private:
  mutable foxglove::TopicFeed feed_;  // gets to know a topic when it is asked whether a client wants it
  mutable std::mutex mutex_;          // of what follows
  double rate_hz_ = kUsualRate_hz;
};

}  // namespace cellmirror::app
