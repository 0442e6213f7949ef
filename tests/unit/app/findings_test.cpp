// Findings on their way from the workers to outputs and status.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "app/io/publisher.hpp"
#include "app/snapshot/object_pool.hpp"
#include "app/snapshot/proximity_board.hpp"
#include "app/workers/result_age.hpp"

namespace cellmirror::app {
namespace {

std::shared_ptr<const ProximityState> state(std::uint64_t sequence, std::vector<std::uint64_t> events) {
  auto made = std::make_shared<ProximityState>();
  made->sequence = sequence;
  made->posture_time = Timestamp{static_cast<std::int64_t>(sequence) * 1'000'000};
  for (const std::uint64_t event : events)
    made->events.push_back({event, ProximityChange::touched, "a", "b", 0.0, made->posture_time});
  return made;
}

std::shared_ptr<const RangeReadings> readings(std::uint64_t sequence) {
  auto made = std::make_shared<RangeReadings>();
  made->sequence = sequence;
  made->readings.resize(2);
  return made;
}

struct RecordingOutput final : FindingsOutput {
  void publish_proximity(const ProximityState& found) override {
    states.push_back(found.sequence);
    for (const ProximityEvent& event : found.events) events.push_back(event.sequence);
  }
  void publish_ranges(std::span<const RangeReading> found, RangeSendMode mode) override {
    ranges.push_back(found.size());
    modes.push_back(mode);
  }
  std::vector<std::uint64_t> states, events;
  std::vector<std::size_t> ranges;
  std::vector<RangeSendMode> modes;
};

struct FindingsPublisherTest : testing::Test {
  ProximityBoard proximity;
  Board<RangeReadings> ranges;
  RecordingOutput output;
  FindingsPublisher sut{proximity, ranges};
  void publish() { sut.publish_news(output, RangeSendMode::one_message_for_all); }
};

using Numbers = std::vector<std::uint64_t>;

TEST_F(FindingsPublisherTest, GivesNothingWhereNothingWasFoundYet) {
  publish();
  EXPECT_TRUE(output.states.empty());
  EXPECT_TRUE(output.ranges.empty());
}

// The output has to hear of an old state too, or it could not tell that nothing new comes.
TEST_F(FindingsPublisherTest, GivesTheNewestStateAgainButEveryEventOnce) {
  proximity.publish(state(1, {1, 2}));
  proximity.publish(state(2, {}));
  proximity.publish(state(3, {3}));
  publish();
  publish();
  EXPECT_EQ(output.states, (Numbers{3, 3}));
  EXPECT_EQ(output.events, (Numbers{1, 2, 3}));
  proximity.publish(state(4, {4}));
  publish();
  EXPECT_EQ(output.states, (Numbers{3, 3, 4}));
  EXPECT_EQ(output.events, (Numbers{1, 2, 3, 4}));
}

TEST_F(FindingsPublisherTest, EachOutputGetsAllEventsAtItsOwnRate) {
  FindingsPublisher slow(proximity, ranges);
  RecordingOutput slow_output;
  for (std::uint64_t i = 1; i <= 10; ++i) {
    proximity.publish(state(i, {i}));
    publish();
  }
  slow.publish_news(slow_output, RangeSendMode::one_message_a_sensor);
  EXPECT_EQ(slow_output.states, Numbers{10});
  EXPECT_EQ(slow_output.events, output.events);
}

TEST_F(FindingsPublisherTest, GivesNewReadingsWithTheSendMode) {
  ranges.publish(readings(1));
  publish();
  publish();
  ranges.publish(readings(2));
  publish();
  EXPECT_EQ(output.ranges, (std::vector<std::size_t>{2, 2}));
  EXPECT_EQ(output.modes.front(), RangeSendMode::one_message_for_all);
}

TEST(ProximityBoard, KeepsTheNewestEventsOfMany) {
  ProximityBoard sut;
  EXPECT_EQ(sut.latest(), nullptr);
  constexpr std::uint64_t kMany = ProximityBoard::kKeptEvents + 10;
  for (std::uint64_t i = 1; i <= kMany; ++i) sut.publish(state(i, {i}));
  const auto all = sut.events_after(0);
  ASSERT_EQ(all.size(), ProximityBoard::kKeptEvents);
  EXPECT_EQ(all.front().sequence, 11U);
  EXPECT_EQ(all.back().sequence, kMany);
  EXPECT_EQ(sut.events_after(kMany - 1).size(), 1U);
  EXPECT_TRUE(sut.events_after(kMany).empty());
}

TEST(ObjectPool, UsesWhatNobodyReadsAnyMoreAgain) {
  ObjectPool<std::vector<int>> sut;
  std::shared_ptr<std::vector<int>> first = sut.take();
  first->assign(1000, 7);
  const std::vector<int>* place = first.get();
  EXPECT_NE(sut.take().get(), place) << "somebody reads it";
  first.reset();
  const auto again = sut.take();
  EXPECT_EQ(again.get(), place);
  EXPECT_GE(again->capacity(), 1000U);
}

TEST(ObjectPool, ItsObjectsMayOutliveIt) {
  std::shared_ptr<std::string> object;
  {
    ObjectPool<std::string> sut;
    object = sut.take();
  }
  *object = "still here";
  EXPECT_EQ(*object, "still here");
}

TEST(ObjectPool, ObjectsComeBackFromOtherThreads) {
  ObjectPool<std::vector<int>> sut;
  for (int i = 0; i < 200; ++i) {
    auto object = sut.take();
    object->assign(10, i);
    std::thread reader([held = std::move(object), i] { EXPECT_EQ(held->at(9), i); });
    reader.join();
  }
}

TEST(ResultAge, RecordsTheAgeAtWhichAResultIsReplacedAndForgivesPauses) {
  constexpr std::int64_t kMs = 1'000'000;
  ResultAge sut;
  sut.shown(Timestamp{1 * kMs}, Timestamp{2 * kMs});
  EXPECT_TRUE(sut.age().snapshot().empty());
  sut.shown(Timestamp{3 * kMs}, Timestamp{5 * kMs});
  EXPECT_EQ(sut.age().max(), Nanoseconds(4 * kMs)) << "the first was the newest for 4 ms";
  EXPECT_EQ(sut.visible_after().max(), Nanoseconds(2 * kMs));
  sut.paused();
  sut.shown(Timestamp{5000 * kMs}, Timestamp{5001 * kMs});
  EXPECT_EQ(sut.age().max(), Nanoseconds(4 * kMs));
}

}  // namespace
}  // namespace cellmirror::app
