// A fault of time or transport passes by itself, where that is safe: good samples again, outside of bodies, at rest;
// and the force fades in from zero. What is wrong with data or forces stays.
#include <gtest/gtest.h>

#include "rig.hpp"
#include "rt_core/haptics/re_engagement.hpp"

namespace cellmirror::haptics {
namespace {

using Eigen::Vector3d;
using test_rig::gantry;
using test_rig::model_of;
using test_rig::plain_settings;
using test_rig::plane;
using test_rig::Rig;

constexpr int kHalfSecond = 500;  // ticks
const Vector3d kAbove(0, 0, 0.002);
const Vector3d kInside(0, 0, -0.004);

HapticSettings forgiving() {
  HapticSettings settings = plain_settings();
  settings.re_engage = true;
  settings.engage_time = Nanoseconds{100'000'000};
  return settings;
}

// Engaged, 2 mm above a wall at z = 0.
struct AboveAWall : Rig {
  explicit AboveAWall(const HapticSettings& settings = forgiving()) : Rig(gantry({})) {
    instrument.settings = settings;
    model = model_of({plane(Vector3d::UnitZ(), 0, Vector3d::Zero())}, Vector3d::Zero());
    go(kAbove, 150);
    EXPECT_EQ(state().phase, HapticPhase::active);
  }
  // Says nothing until that is a fault.
  void fall_silent() {
    for (int i = 0; i < 10; ++i) tick();
    EXPECT_EQ(state().fault, HapticFault::stale);
  }
  // The ticks until the fault has passed, with the hand where it is, trembling; -1: not within two seconds.
  int passes_after(const Vector3d& hand = kAbove) {
    for (int i = 1; i <= 4 * kHalfSecond; ++i) {
      tick(hand + Vector3d(i % 2 == 0 ? 1e-4 : 0.0, 0, 0));
      EXPECT_EQ(port.output.force_D.norm(), 0.0) << i;
      if (state().phase != HapticPhase::faulted) return i;
    }
    return -1;
  }
};

TEST(ReEngagement, FollowsARestOfHalfASecondOutsideOfBodies) {
  AboveAWall rig;
  rig.fall_silent();
  EXPECT_EQ(rig.state().awaited, HapticAwaited::device);
  EXPECT_NEAR(rig.passes_after(), kHalfSecond, 5);
  EXPECT_EQ(rig.state().fault, HapticFault::none);
  EXPECT_EQ(rig.state().awaited, HapticAwaited::nothing);
  EXPECT_EQ(rig.state().re_engagements, 1U);
  EXPECT_EQ(rig.state().resets, 0U) << "nobody has reset it";
}

TEST(ReEngagement, FadesTheForceInFromZero) {
  AboveAWall rig;
  rig.fall_silent();
  ASSERT_GT(rig.passes_after(), 0);
  rig.tick(kAbove);
  EXPECT_EQ(rig.state().phase, HapticPhase::engaging);
  rig.go(kInside, 0);  // 12 ticks: a tenth of the time in which it fades in
  EXPECT_GT(rig.port.output.force_D.z(), 0.0);
  EXPECT_LT(rig.port.output.force_D.z(), 1.0) << "all of it is 4 N";
  rig.go(kInside, 150);
  EXPECT_NEAR(rig.port.output.force_D.z(), 4.0, 1e-6);
}

TEST(ReEngagement, OfAnotherProcessInThePlaceOfOneThatEnded) {
  AboveAWall rig;
  rig.device_gone = true;
  rig.tick();
  ASSERT_EQ(rig.state().fault, HapticFault::vanished);
  for (int i = 0; i < 2 * kHalfSecond; ++i) rig.tick();
  EXPECT_EQ(rig.state().phase, HapticPhase::faulted) << "nobody is there";
  rig.port.sample.writer = 78;
  rig.port.sample.sequence = 0;
  rig.device_gone = false;
  EXPECT_NEAR(rig.passes_after({0.01, 0, 0.03}), kHalfSecond, 5);
  rig.go({0.01, 0, 0.03}, 50);
  EXPECT_NEAR((rig.state().x_proxy - Vector3d(0.01, 0, 0.03)).norm(), 0.0, 1e-6) << "the instrument is at the hand";
}

TEST(ReEngagement, OfAnotherProcessInThePlaceOfOneThatSaidGoodbye) {
  AboveAWall rig;
  rig.fresh();
  rig.port.sample.valid = false;  // its last word
  rig.tick();
  ASSERT_EQ(rig.state().fault, HapticFault::invalid);
  EXPECT_EQ(rig.state().awaited, HapticAwaited::reset);
  rig.device_gone = true;
  rig.tick();
  EXPECT_EQ(rig.state().fault, HapticFault::vanished);
  EXPECT_EQ(rig.state().faults, 1U);
  rig.port.sample.writer = 78;
  rig.port.sample.valid = true;
  rig.device_gone = false;
  EXPECT_NEAR(rig.passes_after(), kHalfSecond, 5);
}

TEST(ReEngagement, WaitsForTheHandToLeaveTheBodyThatItIsIn) {
  AboveAWall rig;
  rig.go(kInside, 150);
  rig.fall_silent();
  EXPECT_EQ(rig.passes_after(kInside), -1);
  EXPECT_EQ(rig.state().awaited, HapticAwaited::outside);
  rig.go(kAbove);
  EXPECT_NEAR(rig.passes_after(), kHalfSecond, 10);
}

TEST(ReEngagement, WaitsForTheTipToBeOutsideOfABodyThatCameMeanwhile) {
  AboveAWall rig;
  rig.fall_silent();
  rig.model = model_of({plane(Vector3d::UnitZ(), 0.005, Vector3d::Zero())}, Vector3d::Zero());  // the tip is at 2 mm
  rig.go({0, 0, 0.01});
  EXPECT_EQ(rig.passes_after({0, 0, 0.01}), -1);
  EXPECT_EQ(rig.state().awaited, HapticAwaited::outside);
}

TEST(ReEngagement, OfAProcessThatEndedAfterAFaultOfItsOwnIsNotOffered) {
  AboveAWall rig;
  rig.fresh();
  rig.port.sample.p_DH.x() += 0.1;
  rig.tick();
  ASSERT_EQ(rig.state().fault, HapticFault::jump);
  rig.device_gone = true;
  rig.tick();
  EXPECT_EQ(rig.state().fault, HapticFault::jump) << "its end does not explain the jump";
  EXPECT_EQ(rig.state().awaited, HapticAwaited::reset);
}

TEST(ReEngagement, WaitsForAHandThatMoves) {
  AboveAWall rig;
  rig.fall_silent();
  for (int i = 0; i < 4 * kHalfSecond; ++i) {
    const double there = (i % 100) / 100.0;
    rig.tick(kAbove + Vector3d(0.01 * ((i / 100) % 2 == 0 ? there : 1.0 - there), 0, 0));
    ASSERT_EQ(rig.state().phase, HapticPhase::faulted) << i;
  }
  EXPECT_EQ(rig.state().awaited, HapticAwaited::rest);
  EXPECT_GT(rig.passes_after(), 0);
}

TEST(ReEngagement, WaitsForSurroundingsThatAreOfNow) {
  AboveAWall rig;
  rig.keep_model_new = false;
  for (int i = 0; i < 110; ++i) rig.tick(kAbove);
  ASSERT_EQ(rig.state().fault, HapticFault::stale_model);
  EXPECT_EQ(rig.passes_after(), -1);
  rig.keep_model_new = true;
  EXPECT_GT(rig.passes_after(), 0);
}

TEST(ReEngagement, BeginsAgainWithEveryCause) {
  AboveAWall rig;
  rig.fall_silent();
  for (int i = 0; i < kHalfSecond - 20; ++i) rig.tick(kAbove);
  ASSERT_EQ(rig.state().phase, HapticPhase::faulted);
  for (int i = 0; i < 10; ++i) rig.tick();  // silent again
  EXPECT_NEAR(rig.passes_after(), kHalfSecond, 5);
}

TEST(ReEngagement, IsNotForWhatIsWrongWithTheDevice) {
  AboveAWall rig;
  rig.fresh();
  rig.port.sample.p_DH.x() += 0.1;
  rig.tick();
  ASSERT_EQ(rig.state().fault, HapticFault::jump);
  EXPECT_EQ(rig.state().awaited, HapticAwaited::reset);
  EXPECT_EQ(rig.passes_after(), -1);
  EXPECT_TRUE(rig.sut.reset());
  for (const auto fault : {HapticFault::none, HapticFault::not_finite, HapticFault::invalid, HapticFault::jump,
                           HapticFault::two_writers, HapticFault::not_passive})
    EXPECT_FALSE(passes_by_itself(fault));
  for (const auto fault :
       {HapticFault::stale, HapticFault::vanished, HapticFault::torn, HapticFault::late_tick, HapticFault::stale_model})
    EXPECT_TRUE(passes_by_itself(fault));
}

TEST(ReEngagement, IsNotForTheStrictProfile) {
  AboveAWall rig(plain_settings());
  rig.fall_silent();
  EXPECT_EQ(rig.state().awaited, HapticAwaited::reset);
  EXPECT_EQ(rig.passes_after(), -1);
}

TEST(ReEngagement, DoesNotTakeTheResetAway) {
  AboveAWall rig;
  rig.go(kInside, 150);
  rig.fall_silent();
  for (int i = 0; i < 30; ++i) rig.tick(kInside);
  EXPECT_TRUE(rig.sut.reset()) << "at once, and inside of a body too: what is felt begins with zero";
  EXPECT_EQ(rig.state().awaited, HapticAwaited::nothing);
  EXPECT_EQ(rig.state().re_engagements, 0U);
}

}  // namespace
}  // namespace cellmirror::haptics
