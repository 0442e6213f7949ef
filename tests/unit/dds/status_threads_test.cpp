// What reads a robot's share of a topic from other threads while messages arrive, without the router's lock.
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <thread>
#include <vector>

#include "drivers/dds/joint_state_router.hpp"

namespace cellmirror::dds::test {
namespace {

struct CountingSink final : JointSampleSink {
  bool push(const JointSample& /*sample*/) noexcept override {
    ++count;
    return count % 3 != 0;
  }
  std::uint64_t count = 0;
};

// Three samples, of which the sink refuses one, then a message that is no JointState.
TEST(StatusThreads, EveryReportIsOfOneInstant) {
  constexpr std::uint64_t kRounds = 3'000;
  const auto feed = RobotFeed::make({{"a", 0, 1.0, 0.0}}).value();
  CountingSink sink;
  JointStateRouter sut;
  sut.add(*feed, sink);
  std::vector<std::byte> good;
  encode(JointState{.name = {"a"}, .position = {1.0}}, good);
  const std::vector<std::byte> bad(3);

  std::mutex readers;  // of the readers: the router's thread has none
  std::atomic<bool> stop{false};
  const auto watch = [&] {
    FeedCounters before;
    while (!stop) {
      const std::lock_guard lock(readers);
      const FeedCounters now = feed->report().counters;
      const std::size_t errors = feed->reported_errors().size();
      ASSERT_LE(errors, 1U);
      const std::uint64_t arrived = now.received + now.sink_full;
      ASSERT_GE(arrived, 3 * now.malformed);
      ASSERT_LE(arrived, 3 * now.malformed + 3);
      ASSERT_GE(now.sink_full, before.sink_full);
      ASSERT_EQ(now.rejected, now.malformed);
      before = now;
    }
  };
  std::thread first(watch);
  std::thread second(watch);
  for (std::uint64_t i = 0; i < kRounds; ++i) {
    for (int k = 0; k < 3; ++k) sut.accept(good, Timestamp{1'000'000'000});
    sut.accept(bad, Timestamp{1'000'000'000});
  }
  stop = true;
  first.join();
  second.join();
  const FeedReport& report = feed->report();
  EXPECT_EQ(report.counters.received, 2 * kRounds);
  EXPECT_EQ(report.counters.sink_full, kRounds);
  EXPECT_EQ(report.counters.malformed, kRounds);
  EXPECT_EQ(report.last_receive_time, Timestamp{1'000'000'000});
  EXPECT_EQ(feed->reported_errors().size(), 1U);
}

}  // namespace
}  // namespace cellmirror::dds::test
