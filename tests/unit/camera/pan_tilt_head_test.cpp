// The head and its faults in virtual time, and the text form of the faults.
#include "sim_devices/camera/pan_tilt_head.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace cellmirror::sim {
namespace {

constexpr Timestamp kBegin{1'000'000'000};
constexpr Nanoseconds kMillisecond{1'000'000};

CameraRecord record(double pan, double tilt, bool tracking = true, bool mirrored = true) {
  CameraRecord made;
  made.id = "C";
  made.pan = pan;
  made.tilt = tilt;
  made.tracking = tracking;
  made.mirrored = mirrored;
  if (tracking) made.tracks = "Hand";
  return made;
}

class PanTiltHeadTest : public ::testing::Test {
 protected:
  PanTiltHeadTest() {
    sut.start(kBegin);
    now = kBegin;
  }
  void run_ms(int ms) {
    for (int i = 0; i < ms; ++i) {
      now = now + kMillisecond;
      sut.advance(now);
    }
  }
  int order(const std::string& text) {
    const auto spec = parse_head_fault(text);
    EXPECT_TRUE(spec) << spec.error().text();
    return sut.add_fault(*spec, now).value_or(-1);
  }
  double pan() const { return sut.axis(0).position(); }
  double tilt() const { return sut.axis(1).position(); }

  PanTiltHead sut{HeadConfig{}};
  Timestamp now;
};

TEST_F(PanTiltHeadTest, GoesWhereTheRecordSays) {
  sut.follow(record(0.5, -0.25), now);
  run_ms(3000);
  EXPECT_EQ(pan(), 0.5);
  EXPECT_EQ(tilt(), -0.25);
  EXPECT_EQ(sut.counters().followed, 1U);
}

TEST_F(PanTiltHeadTest, FollowsASimulatedHeadButNotItsOwnEcho) {
  sut.follow(record(0.5, 0, false, true), now);  // mirrored, tracks nothing: that is where it was itself
  run_ms(1000);
  EXPECT_EQ(pan(), 0);
  EXPECT_EQ(sut.counters().echoes, 1U);
  sut.follow(record(0.5, 0, false, false), now);  // moved in the model alone
  run_ms(2000);
  EXPECT_EQ(pan(), 0.5);
}

TEST_F(PanTiltHeadTest, StopsHoldAndAreCounted) {
  sut.follow(record(9, -9), now);
  run_ms(5000);
  EXPECT_EQ(pan(), 3.0);
  EXPECT_EQ(tilt(), -1.4);
  EXPECT_EQ(sut.counters().beyond, 1U);
}

TEST_F(PanTiltHeadTest, WhatIsNotFiniteIsIgnored) {
  sut.follow(record(std::numeric_limits<double>::quiet_NaN(), 0), now);
  sut.follow(record(0, std::numeric_limits<double>::infinity()), now);
  run_ms(100);
  EXPECT_EQ(pan(), 0);
  EXPECT_EQ(sut.counters().ignored, 2U);
}

TEST_F(PanTiltHeadTest, AStuckAxisStandsUntilTheWindowEnds) {
  order("stuck:joint=1@0..1");
  sut.follow(record(0.5, 0.5), now);
  run_ms(900);
  EXPECT_EQ(pan(), 0);
  EXPECT_GT(tilt(), 0.4);
  run_ms(3000);
  EXPECT_EQ(pan(), 0.5);
  EXPECT_GT(sut.faults().front().applied, 800U);
}

TEST_F(PanTiltHeadTest, ASlowAxisComesLate) {
  order("slow:by=0.1,joint=1");
  sut.follow(record(1, 1), now);
  run_ms(1500);
  EXPECT_LT(pan(), 0.25);
  EXPECT_GT(tilt(), 0.9);
}

TEST_F(PanTiltHeadTest, ARunawayEndsAtTheStopAndComesBack) {
  const int id = order("runaway:joint=2");
  run_ms(3000);
  EXPECT_EQ(tilt(), 1.4);
  EXPECT_EQ(pan(), 0);
  EXPECT_EQ(sut.end_faults(id, {}, now), 1U);
  run_ms(3000);
  EXPECT_EQ(tilt(), 0);
}

TEST_F(PanTiltHeadTest, ADeafHeadIgnoresRecords) {
  order("deaf@0..1");
  sut.follow(record(0.5, 0), now);
  run_ms(1100);
  EXPECT_EQ(pan(), 0);
  EXPECT_EQ(sut.counters().ignored, 1U);
  sut.follow(record(0.5, 0), now);
  run_ms(2000);
  EXPECT_EQ(pan(), 0.5);
}

TEST_F(PanTiltHeadTest, ALateHeadObeysLater) {
  order("late:s=1");
  sut.follow(record(0.5, 0), now);
  run_ms(990);
  EXPECT_EQ(pan(), 0);
  run_ms(2000);
  EXPECT_EQ(pan(), 0.5);
}

TEST_F(PanTiltHeadTest, HeldItStands) {
  sut.hold(true);
  sut.follow(record(0.5, 0), now);
  run_ms(500);
  EXPECT_EQ(pan(), 0);
  sut.hold(false);
  run_ms(2000);
  EXPECT_EQ(pan(), 0.5);
}

TEST_F(PanTiltHeadTest, HasRoomForSoManyFaultsAndEndsThemByKind) {
  for (std::size_t i = 0; i < PanTiltHead::kMostFaults; ++i) EXPECT_GE(order("slow"), 1001);
  EXPECT_FALSE(sut.add_fault(*parse_head_fault("deaf"), now));
  EXPECT_EQ(sut.end_faults(0, HeadFaultKind::deaf, now), 0U);
  EXPECT_EQ(sut.end_faults(0, HeadFaultKind::slow, now), PanTiltHead::kMostFaults);
  EXPECT_TRUE(sut.faults().empty());
}

TEST_F(PanTiltHeadTest, FaultsWhoseTimeIsOverMakeRoomForOthers) {
  for (std::size_t i = 0; i < PanTiltHead::kMostFaults; ++i) order("slow@0..1");
  EXPECT_FALSE(sut.add_fault(*parse_head_fault("deaf"), now));
  run_ms(1100);
  EXPECT_TRUE(sut.add_fault(*parse_head_fault("deaf"), now));
  EXPECT_EQ(sut.faults().size(), 1U);
}

TEST_F(PanTiltHeadTest, ClearForgetsThemButCountsOnlyThoseInForce) {
  order("slow@0..1");
  order("stuck");
  run_ms(1100);
  EXPECT_EQ(sut.end_faults(0, {}, now), 1U);
  EXPECT_TRUE(sut.faults().empty());
}

TEST(HeadFault, IsReadWithItsKeysAndWindow) {
  const auto sut = parse_head_fault(" slow:by=0.25,joint=2@3..4.5 ");
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->kind, HeadFaultKind::slow);
  EXPECT_EQ(sut->scale, 0.25);
  EXPECT_EQ(sut->joint, 2);
  EXPECT_EQ(sut->from_s, 3);
  EXPECT_EQ(sut->until_s, 4.5);
  EXPECT_TRUE(is_head_fault("stuck@4"));
  EXPECT_FALSE(is_head_fault("jump:by=0.5"));
}

TEST(HeadFault, RefusesWhatItCannotBe) {
  for (const char* text : {"stuk", "", ":", "stuck:joint=3", "stuck:joint", "slow:by=2", "slow:by=nan", "late:s=0",
                           "deaf:joint=1", "stuck@", "stuck@4..3", "stuck@-1", "stuck@x", "late:s=1e9", "slow:=1"}) {
    const auto sut = parse_head_fault(text);
    ASSERT_FALSE(sut) << text;
    EXPECT_NE(sut.error().remedy, "") << text;
  }
  EXPECT_NE(parse_head_fault("stuk").error().text().find("did you mean stuck"), std::string::npos);
  EXPECT_FALSE(parse_head_fault("stuck" + std::string(300, ' ') + "@1"));
}

}  // namespace
}  // namespace cellmirror::sim
