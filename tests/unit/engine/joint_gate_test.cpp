#include "rt_core/engine/joint_gate.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/engine/commands.hpp"

namespace cellmirror::engine {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kPeriod_s = 1e-3;
constexpr JointSet kBoth = 0b11;

// Two joints within +-1, at 0.1 and 0.2.
struct JointGateTest : testing::Test {
  JointGateTest() { EXPECT_EQ(sut.add(2, JointValues{0.1, 0.2}, limits), LimiterVerdict::passed); }

  static GatedStep to(double a, double b, JointSet joints = kBoth) {
    GatedStep step{.joints = joints, .next = {a, b}, .dt = kPeriod_s};
    step.fastest.fill(1.0);
    return step;
  }
  [[nodiscard]] double at(std::size_t joint) const { return sut.state().joints[joint].position; }

  JointLimits limits = robot_of(2, -1.0, 1.0).limits;
  JointGate sut;
};

TEST_F(JointGateTest, ARobotThatWouldBeginBeyondItsLimitsOrNowhereIsRefused) {
  JointGate other;
  EXPECT_EQ(other.add(2, JointValues{0.0, 1.1}, limits), LimiterVerdict::beyond_limit);
  EXPECT_EQ(other.add(2, JointValues{kNaN, 0.0}, limits), LimiterVerdict::not_finite);
  EXPECT_EQ(other.state().mode, RobotMode::absent);
  EXPECT_EQ(other.add(2, JointValues{0.0, 1.0, kNaN}, limits), LimiterVerdict::passed) << "the third is no joint";
  EXPECT_EQ(sut.add(2, JointValues{kNaN, 0.0}, limits), LimiterVerdict::not_finite);
  EXPECT_EQ(at(0), 0.1) << "the robot that was there stays";
}

TEST_F(JointGateTest, WritesTheJointsOfTheRobotAndOfTheStepOnly) {
  GatedStep step = to(0.1005, 0.2005, 0b101);
  step.next[2] = 0.0005;
  ASSERT_EQ(sut.step(step), LimiterVerdict::passed);
  EXPECT_EQ(at(0), 0.1005);
  EXPECT_EQ(at(1), 0.2);
  EXPECT_EQ(at(2), 0.0);
  ASSERT_EQ(sut.jump({0.5, 0.6, 0.7}, 0b110), LimiterVerdict::passed);
  EXPECT_EQ(at(0), 0.1005);
  EXPECT_EQ(at(1), 0.6);
  EXPECT_EQ(at(2), 0.0);
}

TEST_F(JointGateTest, AStepPassesAsAWholeOrTheRobotStands) {
  ASSERT_EQ(sut.step(to(0.1005, 0.2005)), LimiterVerdict::passed);
  GatedStep fast = to(0.101, 0.3);
  fast.velocity = {0.5, 0.5};
  EXPECT_EQ(sut.step(fast), LimiterVerdict::too_fast);
  EXPECT_EQ(at(0), 0.1005);
  EXPECT_EQ(sut.state().joints[0].velocity, 0.0);
  EXPECT_EQ(sut.state().refused_setpoints, 1U);
  GatedStep nowhere = to(0.1005, 0.2005);
  nowhere.velocity[1] = kNaN;
  EXPECT_EQ(sut.step(nowhere), LimiterVerdict::not_finite);
  nowhere = to(0.1005, 0.2005);
  nowhere.fastest[0] = kNaN;
  EXPECT_EQ(sut.step(nowhere), LimiterVerdict::too_fast);
}

TEST_F(JointGateTest, AJointBeyondANarrowedLimitMayComeBackOnly) {
  limits.upper[0] = 0.0;
  sut.set_limits(limits);
  EXPECT_EQ(sut.step(to(0.1005, 0.2)), LimiterVerdict::beyond_limit);
  EXPECT_EQ(sut.step(to(0.0995, 0.2)), LimiterVerdict::passed);
  EXPECT_EQ(sut.jump({0.05, 0.2}, kBoth), LimiterVerdict::beyond_limit);
  limits.upper[1] = kNaN;
  sut.set_limits(limits);
  EXPECT_EQ(sut.step(to(0.099, 0.2)), LimiterVerdict::beyond_limit) << "a limit that is no number";
}

TEST_F(JointGateTest, AccelerationAndJerkCountFromStepToStepAndFromRest) {
  limits.acceleration.fill(100.0);
  limits.jerk.fill(100'000.0);
  sut.set_limits(limits);
  constexpr double kWay = 100.0 * kPeriod_s * kPeriod_s;  // of the first step out of rest, at the limit
  ASSERT_EQ(sut.step(to(0.1 + kWay, 0.2)), LimiterVerdict::passed);
  ASSERT_EQ(sut.step(to(0.1 + 3 * kWay, 0.2)), LimiterVerdict::passed);
  EXPECT_EQ(sut.step(to(0.1 + 7 * kWay, 0.2)), LimiterVerdict::beyond_acceleration);
  EXPECT_EQ(sut.step(to(0.1 + 5 * kWay, 0.2)), LimiterVerdict::beyond_acceleration) << "it stands since";
  ASSERT_EQ(sut.step(to(0.1 + 4 * kWay, 0.2)), LimiterVerdict::passed);
  ASSERT_EQ(sut.step(to(0.1 + 6 * kWay, 0.2)), LimiterVerdict::passed);
  sut.stand(kBoth);
  EXPECT_EQ(sut.step(to(0.1 + 8 * kWay, 0.2)), LimiterVerdict::beyond_acceleration);
  limits.acceleration.fill(1e6);
  sut.set_limits(limits);
  EXPECT_EQ(sut.step(to(0.1 + 8 * kWay, 0.2)), LimiterVerdict::beyond_jerk);
}

TEST_F(JointGateTest, ASampleWithoutATimeOrFromTheFutureIsNotTaken) {
  const Timestamp now{1'000'000'000};
  sut.set_mode(RobotMode::mirrored, {Nanoseconds(5'000'000), Nanoseconds(20'000'000)}, kBoth);
  JointSample sample;
  sample.present = 0b11;
  sample.position = {0.7, 0.8};
  sut.take(sample, now);
  sut.age(now);
  EXPECT_EQ(sut.state().state, DataState::invalid);
  EXPECT_EQ(at(0), 0.1);
  sample.receive_time = now + Nanoseconds(200'000'000);
  sut.take(sample, now);
  sut.age(now);
  EXPECT_EQ(sut.state().state, DataState::invalid);
  EXPECT_EQ(sut.state().refused_values, 4U);
  sample.receive_time = now + Nanoseconds(50'000);  // while the tick was at work
  sut.take(sample, now);
  sut.age(now);
  EXPECT_EQ(sut.state().state, DataState::fresh);
  EXPECT_EQ(at(1), 0.8);
  sample.receive_time = now - Nanoseconds(6'000'000);
  sut.take(sample, now);
  sut.age(now);
  EXPECT_EQ(sut.state().state, DataState::stale) << "old when it came";
}

TEST_F(JointGateTest, ASimulatedRobotTakesNoSamples) {
  JointSample sample;
  sample.present = 0b11;
  sample.receive_time = Timestamp{1};
  sut.take(sample, Timestamp{1});
  EXPECT_EQ(sut.state().samples, 0U);
  EXPECT_EQ(at(0), 0.1);
}

}  // namespace
}  // namespace cellmirror::engine
