// Closed forms of profiles with constant acceleration.
#include "drivers/can/cia402/device/motion_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace cellmirror::can {
namespace {

constexpr MotionLimits kLimits{.velocity = 100, .acceleration = 50, .deceleration = 100};

void expect_point(const MotionPlan& plan, double t, double position, double velocity) {
  EXPECT_NEAR(plan.at(t).position, position, 1e-9) << t;
  EXPECT_NEAR(plan.at(t).velocity, velocity, 1e-9) << t;
}

// Whatever the plan is, velocity is the derivative of position, and both are without a jump.
void expect_smooth(const MotionPlan& plan, double fastest) {
  constexpr double kDt = 1e-4;
  for (double t = 0; t < plan.duration() + 0.1; t += kDt) {
    const MotionPoint a = plan.at(t);
    const MotionPoint b = plan.at(t + kDt);
    ASSERT_NEAR(b.position - a.position, 0.5 * (a.velocity + b.velocity) * kDt, 1e-5) << t;
    ASSERT_LE(std::abs(b.velocity - a.velocity), 100 * kDt + 1e-9) << t;
    ASSERT_LE(std::abs(a.velocity), fastest + 1e-9) << t;
  }
}

// 2 s up (100 u), 8.5 s plateau (850 u), 1 s down (50 u).
TEST(MotionPlan, IsATrapezoidOfTheVelocity) {
  const MotionPlan plan = MotionPlan::to_position({}, 1000, kLimits);
  EXPECT_NEAR(plan.duration(), 11.5, 1e-12);
  expect_point(plan, 0, 0, 0);
  expect_point(plan, 1, 25, 50);
  expect_point(plan, 2, 100, 100);
  expect_point(plan, 6, 500, 100);
  expect_point(plan, 11, 987.5, 50);
  expect_point(plan, 11.5, 1000, 0);
  expect_point(plan, 20, 1000, 0);
  EXPECT_EQ(plan.at(1).acceleration, 50);
  EXPECT_EQ(plan.at(5).acceleration, 0);
  EXPECT_EQ(plan.at(11).acceleration, -100);
  expect_smooth(plan, 100);
}

// Below 150 u there is no plateau: v^2 = 2 a d D / (a + d).
TEST(MotionPlan, IsATriangleOverAShortDistance) {
  const MotionPlan plan = MotionPlan::to_position({}, -75, kLimits);
  const double fastest = std::sqrt(2 * 50.0 * 100 * 75 / 150);
  EXPECT_NEAR(plan.duration(), fastest / 50 + fastest / 100, 1e-12);
  expect_point(plan, fastest / 50, -fastest * fastest / 100, -fastest);
  expect_point(plan, plan.duration(), -75, 0);
  expect_smooth(plan, fastest);
}

TEST(MotionPlan, ToWhereItStandsTakesNoTime) {
  const MotionPlan plan = MotionPlan::to_position({5, 0, 0}, 5, kLimits);
  EXPECT_EQ(plan.duration(), 0);
  expect_point(plan, 1, 5, 0);
}

TEST(MotionPlan, GoesOnFromAMotion) {
  const MotionPlan plan = MotionPlan::to_position({0, 50, 0}, 1000, kLimits);
  expect_point(plan, 0, 0, 50);
  expect_point(plan, 1, 75, 100);
  EXPECT_NEAR(plan.duration(), 1 + (1000 - 75 - 50) / 100.0 + 1, 1e-12);
  expect_smooth(plan, 100);
}

// It stands after 0.5 s and 12.5 u, then comes back.
TEST(MotionPlan, ComesBackToATargetBehindIt) {
  for (const double target : {-100.0, 10.0}) {
    const MotionPlan plan = MotionPlan::to_position({0, 50, 0}, target, kLimits);
    expect_point(plan, 0.5, 12.5, 0);
    expect_point(plan, plan.duration(), target, 0);
    expect_smooth(plan, 100);
  }
}

TEST(MotionPlan, SlowsDownToALowerLimit) {
  const MotionPlan plan = MotionPlan::to_position({0, 200, 0}, 1000, kLimits);
  expect_point(plan, 1, 150, 100);
  expect_point(plan, plan.duration(), 1000, 0);
  expect_smooth(plan, 200);
}

TEST(MotionPlan, RampsToAVelocityThroughAStandstill) {
  const MotionPlan plan = MotionPlan::to_velocity({0, 50, 0}, -50, kLimits);
  EXPECT_NEAR(plan.duration(), 1.5, 1e-12);
  expect_point(plan, 0.5, 12.5, 0);
  expect_point(plan, 1.5, -12.5, -50);
  expect_point(plan, 2.5, -62.5, -50);
  expect_smooth(plan, 50);
}

TEST(MotionPlan, KeepsToTheVelocityLimit) {
  EXPECT_NEAR(MotionPlan::to_velocity({}, 1e9, kLimits).at(100).velocity, 100, 1e-12);
}

}  // namespace
}  // namespace cellmirror::can
