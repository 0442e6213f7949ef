// What the summary of a cell says of it, and when it is sent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/io/summary_publisher.hpp"
#include "app/report/cell_summary_builder.hpp"
#include "tests/unit/app/live_sources.hpp"

namespace cellmirror::app {
namespace {

using testing::ElementsAre;

constexpr Timestamp kSummaryTime{10'000'000'000};

class CellSummaryBuilder : public testing::Test {
 protected:
  CellSummaryBuilder() { facts_.loop = {true, "ok"}; }
  [[nodiscard]] CellSummary summary() {
    LiveSources sources = gateway_.sources(kSummaryTime);
    sources.proximity = proximity_;
    sources.problems = problems_;
    sources.alarms = alarms_;
    return summary_of(sources, facts_);
  }
  void mirror(DataState state) {
    gateway_.robots[0].online = true;
    gateway_.robots[0].state = state;
  }

  SmallGateway gateway_;
  SummaryFacts facts_;
  std::shared_ptr<ProximityState> proximity_;
  Problems problems_;
  AlarmCounts alarms_;
};

TEST_F(CellSummaryBuilder, ACellWithoutTroubleIsOk) {
  facts_.page_port = 8420;
  const CellSummary sut = summary();
  EXPECT_EQ(sut.cell, "small");
  EXPECT_EQ(sut.health, CellHealth::ok);
  EXPECT_TRUE(sut.reasons.empty());
  EXPECT_TRUE(sut.loop.on_time);
  EXPECT_EQ(sut.page_port, 8420);
  EXPECT_EQ(sut.robots, (std::vector<RobotSummary>{{"ARM", false, DataState::none, {}}}));
}

TEST_F(CellSummaryBuilder, AMirroredRobotHasItsStateAndAge) {
  mirror(DataState::stale);
  gateway_.tick.robots[0].receive_time = kSummaryTime - Nanoseconds(250'000'000);
  const CellSummary sut = summary();
  ASSERT_EQ(sut.robots.size(), 1U);
  EXPECT_EQ(sut.robots[0].state, DataState::stale);
  EXPECT_DOUBLE_EQ(sut.robots[0].age_s.value(), 0.25);
  EXPECT_EQ(sut.health, CellHealth::attention);
  EXPECT_THAT(sut.reasons, ElementsAre("ARM: stale"));
}

TEST_F(CellSummaryBuilder, FreshDataAreNoReason) {
  mirror(DataState::fresh);
  EXPECT_EQ(summary().health, CellHealth::ok);
}

TEST_F(CellSummaryBuilder, ContactsAreNamedAndNearestIsZeroThen) {
  proximity_ = std::make_shared<ProximityState>();
  proximity_->names = std::make_shared<const std::vector<std::string>>(std::vector<std::string>{"A.hand", "TABLE"});
  TouchingPair pair;
  pair.b = 1;
  proximity_->touching.push_back(pair);
  const CellSummary sut = summary();
  EXPECT_EQ(sut.touching, 1U);
  EXPECT_EQ(sut.touching_pairs, (std::vector<BodyPair>{{"A.hand", "TABLE"}}));
  ASSERT_TRUE(sut.nearest);
  EXPECT_EQ(sut.nearest->distance_m, 0);
  EXPECT_THAT(sut.reasons, ElementsAre("1 pair of bodies in contact"));
}

TEST_F(CellSummaryBuilder, TheWorstReasonDecides) {
  mirror(DataState::lost);
  alarms_.states[0] = 2;
  problems_ = {{"script_queue", "the queue is full"}};
  facts_.loop = {false, "the loop stands still"};
  const CellSummary sut = summary();
  EXPECT_EQ(sut.health, CellHealth::fault);
  EXPECT_FALSE(sut.loop.on_time);
  EXPECT_EQ(sut.alarms.unacknowledged, 2U);
  EXPECT_THAT(sut.reasons, ElementsAre("the loop stands still", "the queue is full", "ARM: lost",
                                       "2 alarms that nobody has acknowledged"));
}

TEST_F(CellSummaryBuilder, MoreRobotsThanFitAreCounted) {
  while (gateway_.picture.robots.size() < 100) {
    gateway_.picture.robots.push_back(gateway_.picture.robots[0]);
    gateway_.robots.push_back(gateway_.robots[0]);
  }
  const CellSummary sut = summary();
  EXPECT_EQ(sut.robots.size(), kMostSummaryRobots);
  EXPECT_EQ(sut.robots_left_out, 100 - kMostSummaryRobots);
}

constexpr Timestamp instant_ms(std::int64_t ms) { return Timestamp{1'000'000'000 + ms * 1'000'000}; }

TEST(SummaryPaceTest, TwiceASecondWhereNothingHappens) {
  SummaryPace sut;
  const CellSummary quiet;
  int sent = 0;
  for (int ms = 0; ms < 10'000; ms += 50) sent += sut.due(quiet, instant_ms(ms)) ? 1 : 0;
  EXPECT_EQ(sent, 20);
}

TEST(SummaryPaceTest, NewsAreSentAtOnceButAtMostTenTimesASecond) {
  SummaryPace sut;
  CellSummary summary;
  ASSERT_TRUE(sut.due(summary, instant_ms(0)));
  EXPECT_FALSE(sut.due(summary, instant_ms(150)));
  summary.touching = 1;
  EXPECT_TRUE(sut.due(summary, instant_ms(200)));
  summary.touching = 2;
  EXPECT_FALSE(sut.due(summary, instant_ms(250))) << "too early";
  EXPECT_TRUE(sut.due(summary, instant_ms(300))) << "not forgotten";
  int sent = 0;
  for (int ms = 1000; ms < 11'000; ms += 50) {
    ++summary.touching;
    sent += sut.due(summary, instant_ms(ms)) ? 1 : 0;
  }
  EXPECT_EQ(sent, 100);
}

}  // namespace
}  // namespace cellmirror::app
