// Two senders under one identifier: two drives with one node id, two devices that send one message of a DBC.
#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <string>

#include "drivers/can/alternation_watch.hpp"
#include "drivers/can/dbc/session.hpp"
#include "tests/unit/can/session_fixture.hpp"

namespace cellmirror::can {
namespace {

using testing::HasSubstr;

constexpr Nanoseconds kTenMs{10'000'000};

struct AlternationTest : testing::Test {
  bool take(double value, Nanoseconds later = kTenMs) {
    now = now + later;
    return sut.take(value, now);
  }
  AlternationWatch sut;
  Timestamp now{1'000'000'000};
};

TEST_F(AlternationTest, ValuesOfTwoThatAlternateAreFoundWithinEight) {
  int found = -1;
  for (int i = 0; i < 20 && found < 0; ++i) {
    if (take(i % 2 == 0 ? 0.1 + 1e-4 * i : 0.7 - 1e-4 * i)) found = i;
  }
  EXPECT_EQ(found, 7) << "one jump, and six ways back";
  EXPECT_NEAR(sut.places().a, 0.7, 0.01);
  EXPECT_NEAR(sut.places().b, 0.1, 0.01);
}

TEST_F(AlternationTest, OneMayBeSlowerThanTheOther) {
  bool found = false;
  for (int i = 0; i < 60; ++i) found = take(i % 5 == 0 ? 0.7 : 0.1 + 1e-4 * i) || found;
  EXPECT_TRUE(found);
}

TEST_F(AlternationTest, ItIsOverASecondAfterTheLastJump) {
  for (int i = 0; i < 20; ++i) take(i % 2 == 0 ? 0.1 : 0.7);
  int more = 0;
  while (take(0.7) && more < 1000) ++more;
  EXPECT_NEAR(more, 100, 1);
}

TEST_F(AlternationTest, RobotsThatMoveStandOrTrembleAreOne) {
  for (int i = 0; i < 2000; ++i) ASSERT_FALSE(take(std::sin(0.01 * i * 6.28), kTenMs)) << "1 Hz, " << i;
  for (int i = 0; i < 200; ++i) ASSERT_FALSE(take(0.3 * i, 100 * kTenMs / 10)) << "large steps";
  for (int i = 0; i < 200; ++i) ASSERT_FALSE(take(0.5 + (i % 2 == 0 ? 0.009 : -0.009))) << "an encoder that trembles";
  for (int i = 0; i < 200; ++i) ASSERT_FALSE(take(i % 2 == 0 ? 0.1 : 0.7, 150 * kTenMs)) << "too slow to tell";
}

struct TwoDrives : SessionTest {
  TwoDrives() { start(); }
};

TEST_F(TwoDrives, PutTheJointInConflictAndAreNamed) {
  for (int i = 0; i < 10; ++i) {
    at(kTenMs);
    tpdo(3, 100 + i);
    tpdo(4, 500);
    at(kTenMs / 2);
    tpdo(3, 700);
  }
  const JointSample& newest = out.samples.back();
  EXPECT_EQ(newest.conflict, 1U);
  EXPECT_EQ(newest.present, 0U);
  EXPECT_EQ(out.samples[out.samples.size() - 2].present, 2U) << "the other drive is one";
  const auto nodes = sut->nodes();
  EXPECT_GT(nodes[0].conflicts, 5U);
  EXPECT_EQ(nodes[1].conflicts, 0U);
  EXPECT_EQ(words(nodes[0], now), "two drives answer: near 0.7 and 0.109 rad or m");
  EXPECT_THAT(condition(nodes, now), HasSubstr("node 3 (J_1): two drives answer"));
  const auto kinds = out.kinds();
  EXPECT_EQ(std::ranges::count(kinds, Cia402EventKind::second_drive), 1);
  for (int i = 0; i < 120; ++i) {
    at(kTenMs);
    tpdo(3, 700);
  }
  EXPECT_EQ(out.samples.back().conflict, 0U) << "the other one is gone";
  EXPECT_EQ(out.samples.back().present, 1U);
  EXPECT_THAT(condition(sut->nodes(), now), testing::Not(HasSubstr("two drives")));
}

TEST_F(TwoDrives, ABootUpOfANodeThatIsOperationalIsTold) {
  const auto heartbeat = [this](int state) { sut->receive(frame(0x703, {state}), now); };
  heartbeat(0);
  heartbeat(5);
  heartbeat(0);
  ASSERT_GE(out.events.size(), 2U);
  EXPECT_EQ(out.events[0].text, "node 3 (J_1): boot-up");
  EXPECT_EQ(out.events.back().text,
            "node 3 (J_1): boot-up while it was operational: it was reset, or a second drive has its id");
}

TEST_F(TwoDrives, HeartbeatsThatComeTwiceAsOftenAreTold) {
  const auto heartbeat = [this](Nanoseconds later) {
    at(later);
    sut->receive(frame(0x703, {5}), now);
  };
  for (int i = 0; i < 20; ++i) heartbeat(10 * kTenMs + Nanoseconds(i % 3 * 1'000'000));
  EXPECT_FALSE(sut->nodes()[0].doubled_heartbeats) << "they are not regular to the millisecond";
  for (int i = 0; i < 10; ++i) {
    heartbeat(3 * kTenMs);
    heartbeat(7 * kTenMs);
  }
  EXPECT_TRUE(sut->nodes()[0].doubled_heartbeats);
  EXPECT_THAT(words(sut->nodes()[0], now), HasSubstr("heartbeats twice as often"));
  EXPECT_THAT(out.events.back().text, HasSubstr("node 3 (J_1): heartbeats come twice as often as before"));
  heartbeat(10 * kTenMs);
  heartbeat(10 * kTenMs);
  EXPECT_FALSE(sut->nodes()[0].doubled_heartbeats);
}

TEST(HeartbeatCadence, KeepsItsPeriodWhenHeartbeatsAreLostOrLate) {
  HeartbeatCadence sut;
  Timestamp now{1'000'000'000};
  for (int i = 0; i < 10; ++i) sut.take(now = now + 10 * kTenMs);
  EXPECT_EQ(sut.period(), 10 * kTenMs);
  for (int i = 0; i < 50; ++i) {
    EXPECT_FALSE(sut.take(now = now + (i % 7 == 0 ? 20 : 10) * kTenMs)) << "some are lost";
    EXPECT_FALSE(sut.take(now = now + (i % 2 == 0 ? 13 : 7) * kTenMs)) << "a busy machine";
  }
}

struct DbcOutput : DbcSessionOutput {
  std::vector<JointSample> samples;
  void sample(const JointSample& s) override { samples.push_back(s); }
  void rejected(const std::string&) override {}
  void outside(const std::string&) override {}
};

TEST(TwoSendersOfADbcMessage, PutTheJointInConflict) {
  DbcStreamConfig config;
  config.signals = {{"Axis", "Angle", 2, "J_3", JointQuantity::position, 1.0, 0.0, true}};
  Diagnostics diagnostics;
  Dbc dbc = parse_dbc("BO_ 256 Axis: 2 R\n SG_ Angle : 0|16@1- (0.001,0) [0|0] \"rad\" M\n", "axis.dbc", diagnostics);
  auto plan = plan_dbc(config, std::move(dbc), diagnostics);
  ASSERT_TRUE(plan) << diagnostics.text();
  DbcOutput out;
  DbcSession sut(std::move(*plan), out);
  Timestamp now{1'000'000'000};
  for (int i = 0; i < 10; ++i) {
    now = now + kTenMs;
    sut.receive(frame(256, {i % 2 == 0 ? 100 : 200, 0}), now);
  }
  EXPECT_EQ(out.samples.back().conflict, 0b100U);
  EXPECT_EQ(out.samples.back().present, 0U);
  EXPECT_EQ(sut.counters().conflicts, 3U);
  EXPECT_EQ(sut.trouble().conflict_signal->name, "Angle");
  EXPECT_EQ(sut.trouble().conflict, now);
}

}  // namespace
}  // namespace cellmirror::can
