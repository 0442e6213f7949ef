// What a mirrored robot is shown to be while its stream brings values that cannot be true.
#include <gtest/gtest.h>

#include <limits>

#include "rt_core/engine/joint_gate.hpp"
#include "tests/unit/engine/commands.hpp"

namespace cellmirror::engine {
namespace {

constexpr Nanoseconds kMillisecond{1'000'000};
constexpr JointSet kTwoJoints = 0b11;
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// Two joints that may be within +-3.3 rad and move at 3 rad/s; three plausible values end a doubt.
struct PlausibilityTest : testing::Test {
  PlausibilityTest() {
    EXPECT_EQ(sut.add(2, JointValues{}, robot_of(2, -3.0, 3.0).limits), LimiterVerdict::passed);
    for (KnownLimits& joint : bounds.joints) joint = {.lower = -3.3, .upper = 3.3, .velocity = 3.0};
    bounds.arrival_jitter = 50 * kMillisecond;
    bounds.plausible_after = 3;
    mirror();
  }

  void mirror() { sut.set_mode(RobotMode::mirrored, {100 * kMillisecond, 1000 * kMillisecond}, kTwoJoints, &bounds); }

  // After 10 ms more the stream says this; the state of the robot then.
  DataState say(double a, double b, double velocity = 0.0) {
    now = now + 10 * kMillisecond;
    JointSample sample;
    sample.present = kTwoJoints;
    sample.position = {a, b};
    sample.velocity = {velocity, 0.0};
    sample.receive_time = now;
    sut.take(sample, now);
    sut.age(now);
    return sut.state().state;
  }
  DataState wait(Nanoseconds time) {
    now = now + time;
    sut.age(now);
    return sut.state().state;
  }
  [[nodiscard]] const JointTickState& joint(std::size_t i) const { return sut.state().joints[i]; }

  PlausibilityBounds bounds;
  JointGate sut;
  Timestamp now{1'000'000'000};
};

TEST_F(PlausibilityTest, AJumpBeyondTheRangeIsNotShownAndIsNamed) {
  ASSERT_EQ(say(0.1, 0.2), DataState::fresh);
  EXPECT_EQ(say(0.1, 51471.0), DataState::implausible);
  EXPECT_EQ(joint(1).position, 0.2) << "it stays where it was";
  EXPECT_EQ(joint(1).state, DataState::implausible);
  EXPECT_EQ(joint(1).implausible, Implausibility::position);
  EXPECT_EQ(joint(0).state, DataState::fresh) << "the other one is believed";
  EXPECT_EQ(sut.state().implausible_values, 1U);
  EXPECT_EQ(sut.state().refused_values, 0U);
  const ImplausibleValue& found = sut.state().newest_implausible;
  EXPECT_EQ(found.joint, 1);
  EXPECT_EQ(found.why, Implausibility::position);
  EXPECT_EQ(found.value, 51471.0);
  EXPECT_EQ(found.bound, 3.3);
}

TEST_F(PlausibilityTest, TheFirstValueMayBeAnywhereWithinTheRange) {
  EXPECT_EQ(say(3.2, -3.2), DataState::fresh);
  mirror();
  EXPECT_EQ(say(0.0, -3.4), DataState::implausible);
}

TEST_F(PlausibilityTest, TwoSendersThatAlternateAreNeverBelieved) {
  ASSERT_EQ(say(0.1, 0.0), DataState::fresh);
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(say(0.7, 0.0), DataState::implausible);
    EXPECT_EQ(say(0.1, 0.0), DataState::implausible);
  }
  EXPECT_EQ(joint(0).position, 0.1);
  EXPECT_EQ(joint(0).implausible, Implausibility::velocity);
  EXPECT_EQ(sut.state().implausible_values, 100U);
  EXPECT_NEAR(sut.state().newest_implausible.value, -0.6 / 0.06, 1e-9) << "over 10 ms and the jitter";
}

TEST_F(PlausibilityTest, ItIsShownAgainWithTheThirdPlausibleValueThoughItIsElsewhere) {
  ASSERT_EQ(say(0.1, 0.0), DataState::fresh);
  EXPECT_EQ(say(0.7, 0.0), DataState::implausible);
  EXPECT_EQ(say(0.71, 0.0), DataState::implausible);
  EXPECT_EQ(say(0.72, 0.0), DataState::implausible);
  EXPECT_EQ(joint(0).position, 0.1);
  EXPECT_EQ(say(0.73, 0.0), DataState::fresh);
  EXPECT_EQ(joint(0).position, 0.73);
  EXPECT_EQ(joint(0).implausible, Implausibility::none);
  EXPECT_EQ(sut.state().implausible_values, 3U);
}

TEST_F(PlausibilityTest, ABurstOfValuesOfAFastRobotIsPlausible) {
  ASSERT_EQ(say(0.0, 0.0), DataState::fresh);
  now = now + 200 * kMillisecond;  // they were held up, and come at once
  for (int i = 1; i <= 20; ++i) {
    JointSample sample;
    sample.present = kTwoJoints;
    sample.position = {0.02 * i, 0.0};
    sample.receive_time = now + Nanoseconds(i);
    sut.take(sample, now);
  }
  EXPECT_EQ(wait(kMillisecond), DataState::fresh);
  EXPECT_EQ(joint(0).position, 0.4);
  EXPECT_EQ(sut.state().implausible_values, 0U);
}

TEST_F(PlausibilityTest, ItsOwnVelocityHasABoundToo) {
  ASSERT_EQ(say(0.0, 0.0, 2.9), DataState::fresh);
  EXPECT_EQ(say(0.0, 0.0, -3.1), DataState::implausible);
  EXPECT_EQ(sut.state().newest_implausible.why, Implausibility::velocity);
}

TEST_F(PlausibilityTest, AVelocityThatChangesTooFastIsAnAcceleration) {
  bounds.joints[0].acceleration = 20.0;
  mirror();
  ASSERT_EQ(say(0.0, 0.0, 1.0), DataState::fresh);
  EXPECT_EQ(say(0.0, 0.0, 2.1), DataState::fresh) << "20 rad/s2 over 10 ms and 50 ms of jitter";
  EXPECT_EQ(say(0.0, 0.0, 0.8), DataState::implausible);
  EXPECT_EQ(sut.state().newest_implausible.why, Implausibility::acceleration);
  EXPECT_NEAR(sut.state().newest_implausible.value, -1.3 / 0.06, 1e-9);
}

TEST_F(PlausibilityTest, ValuesThatStayTheSameToTheLastBitAreFrozenWhereAsked) {
  for (int i = 0; i < 300; ++i) ASSERT_EQ(say(0.5, 0.5, 0.1), DataState::fresh) << "not asked";
  bounds.frozen_after = 2000 * kMillisecond;
  mirror();
  for (int i = 0; i < 201; ++i) ASSERT_EQ(say(0.5, 1e-9 * i), DataState::fresh) << i;
  EXPECT_EQ(say(0.5, 0.0), DataState::implausible);
  EXPECT_EQ(joint(0).implausible, Implausibility::frozen);
  EXPECT_EQ(joint(1).state, DataState::fresh) << "its noise is enough";
  EXPECT_EQ(say(0.5 + 1e-15, 0.0), DataState::implausible);
  EXPECT_EQ(say(0.5 - 1e-15, 0.0), DataState::implausible);
  EXPECT_EQ(say(0.5 + 1e-15, 0.0), DataState::fresh);
}

TEST_F(PlausibilityTest, ImplausibleValuesKeepTheStateUntilTheyEndAndThenItIsLost) {
  ASSERT_EQ(say(0.1, 0.0), DataState::fresh);
  for (int i = 0; i < 300; ++i) ASSERT_EQ(say(99.0, 0.0), DataState::implausible) << "for 3 s";
  EXPECT_EQ(wait(900 * kMillisecond), DataState::implausible);
  EXPECT_EQ(wait(200 * kMillisecond), DataState::lost);
  EXPECT_EQ(joint(0).position, 0.1);
}

TEST_F(PlausibilityTest, AfterASilenceItMayBeWhereItCanHaveGone) {
  ASSERT_EQ(say(0.0, 0.0), DataState::fresh);
  EXPECT_EQ(wait(1500 * kMillisecond), DataState::lost);
  EXPECT_EQ(say(3.0, 0.0), DataState::fresh);
}

TEST_F(PlausibilityTest, WhereNoBoundIsKnownEverythingFiniteIsPlausible) {
  for (KnownLimits& joint : bounds.joints) joint = {};
  mirror();
  EXPECT_EQ(say(0.0, 0.0), DataState::fresh);
  EXPECT_EQ(say(51471.0, -1e300, 1e300), DataState::fresh);
  sut.set_mode(RobotMode::mirrored, {100 * kMillisecond, 1000 * kMillisecond}, kTwoJoints);
  EXPECT_EQ(say(51471.0, -1e300, 1e300), DataState::fresh);
  EXPECT_EQ(say(0.0, 0.0), DataState::fresh);
}

TEST_F(PlausibilityTest, GoingOnlineAgainForgetsWhatWas) {
  ASSERT_EQ(say(0.1, 0.0), DataState::fresh);
  EXPECT_EQ(say(99.0, 0.0), DataState::implausible);
  mirror();
  EXPECT_EQ(sut.state().implausible_values, 0U);
  EXPECT_EQ(sut.state().newest_implausible.why, Implausibility::none);
  EXPECT_EQ(say(-2.0, 0.0), DataState::fresh);
}

TEST_F(PlausibilityTest, AJointOfTwoSendersIsInConflictAndHeld) {
  ASSERT_EQ(say(0.1, 0.2), DataState::fresh);
  JointSample sample;
  sample.present = kTwoJoints;
  sample.conflict = 0b01;
  sample.position = {0.15, 0.25};
  for (int i = 0; i < 200; ++i) {
    now = now + 10 * kMillisecond;
    sample.receive_time = now;
    sut.take(sample, now);
    sut.age(now);
    ASSERT_EQ(sut.state().state, DataState::conflict);
  }
  EXPECT_EQ(joint(0).position, 0.1);
  EXPECT_EQ(joint(1).position, 0.25);
  EXPECT_EQ(joint(1).state, DataState::fresh);
  EXPECT_EQ(sut.state().conflicting_values, 200U);
  EXPECT_EQ(say(0.16, 0.2), DataState::fresh) << "the driver says that it is over";
  sample.receive_time = {};
  sut.take(sample, now);
  sut.age(now);
  EXPECT_EQ(sut.state().state, DataState::invalid) << "without a time";
}

TEST(BoundsOfAJoint, AreTheRangeAndItsMarginAndTheLimitsTimesTheirFactors) {
  const KnownLimits known{.lower = -1.0, .upper = 3.0, .velocity = 2.0, .acceleration = 10.0};
  PlausibilityConfig config;
  const KnownLimits bounds = bounds_of(known, config);
  EXPECT_DOUBLE_EQ(bounds.lower, -1.4);
  EXPECT_DOUBLE_EQ(bounds.upper, 3.4);
  EXPECT_DOUBLE_EQ(bounds.velocity, 3.0);
  EXPECT_DOUBLE_EQ(bounds.acceleration, 100.0);
  config.velocity_factor = config.acceleration_factor = 0.0;
  EXPECT_EQ(bounds_of(known, config).velocity, kUnbounded);
  EXPECT_EQ(bounds_of(known, config).acceleration, kUnbounded);
  EXPECT_EQ(bounds_of({}, {}).upper, kUnbounded) << "nothing known";
  EXPECT_EQ(bounds_of({}, {}).lower, -kUnbounded);
  config.enabled = false;
  EXPECT_EQ(bounds_of(known, config).upper, kUnbounded);
}

}  // namespace
}  // namespace cellmirror::engine
