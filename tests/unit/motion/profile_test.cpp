#include "rt_core/motion/profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace cellmirror::motion {
namespace {

constexpr std::array kShapes = {VelocityProfile::ramp, VelocityProfile::sine};

class ProfileOfShape : public testing::TestWithParam<VelocityProfile> {};

// The manual's example: rob_cart_lin_vel 1200, rob_cart_lin_acc 4800 make an acceleration period of 250 ms.
TEST_P(ProfileOfShape, AcceleratesForAQuarterOfASecondTo1200MillimetresASecondWith4800) {
  const Profile sut = Profile::to_target(0, 0, 3.0, {1.2, 4.8}, GetParam());
  EXPECT_NEAR(sut.at(0.25).velocity, 1.2, 1e-12);
  EXPECT_LT(sut.at(0.249).velocity, 1.2);
  EXPECT_NEAR(sut.at(0.25).position, 0.15, 1e-12);  // v^2 / 2a
  EXPECT_NEAR(sut.duration(), 3.0 / 1.2 + 0.25, 1e-12);
  EXPECT_NEAR(sut.at(sut.duration() - 0.25).position, 2.85, 1e-12);
}

TEST_P(ProfileOfShape, HasHalfTheSpeedAndTheClosedFormsWayHalfWayUp) {
  const Profile sut = Profile::to_target(0, 0, 3.0, {1.2, 4.8}, GetParam());
  EXPECT_NEAR(sut.at(0.125).velocity, 0.6, 1e-12);
  // Ramp: a t^2 / 2. Sine: v / 2 (t - T / pi).
  const double way =
      GetParam() == VelocityProfile::ramp ? 0.5 * 4.8 * 0.125 * 0.125 : 0.6 * (0.125 - 0.25 / std::numbers::pi);
  EXPECT_NEAR(sut.at(0.125).position, way, 1e-12);
}

TEST_P(ProfileOfShape, AcceleratesAtItsSteepestAsItIsDocumented) {
  const Profile sut = Profile::to_target(0, 0, 3.0, {1.2, 4.8}, GetParam());
  const double steepest = GetParam() == VelocityProfile::ramp ? 4.8 : 4.8 * std::numbers::pi / 2;
  EXPECT_NEAR(sut.at(0.125).acceleration, steepest, 1e-9);
  EXPECT_NEAR(sut.at(sut.duration() - 0.125).acceleration, -steepest, 1e-9);
}

TEST_P(ProfileOfShape, ShortWayIsATriangle) {
  const Profile sut = Profile::to_target(1.0, 0, 0.9, {1.2, 4.8}, GetParam());
  EXPECT_NEAR(sut.duration(), 2 * std::sqrt(0.1 / 4.8), 1e-12);
  EXPECT_NEAR(sut.at(sut.duration() / 2).velocity, -std::sqrt(0.1 * 4.8), 1e-12);
  EXPECT_EQ(sut.at(sut.duration()).position, 0.9);
}

TEST_P(ProfileOfShape, StandsWhereItIsWhenTheTargetIsThere) {
  const Profile sut = Profile::to_target(0.7, 0, 0.7, {1.2, 4.8}, GetParam());
  EXPECT_EQ(sut.duration(), 0.0);
  EXPECT_EQ(sut.at(0).position, 0.7);
}

TEST_P(ProfileOfShape, TurnsRoundWhenItMovesTheWrongWay) {
  const Profile sut = Profile::to_target(0, -1.0, 1.0, {1.0, 2.0}, GetParam());
  EXPECT_NEAR(sut.at(0.5).velocity, 0.0, 1e-12);
  EXPECT_NEAR(sut.at(0.5).position, -0.25, 1e-12);
  EXPECT_NEAR(sut.duration(), 0.5 + 1.25 / 1.0 + 0.5, 1e-12);
}

TEST_P(ProfileOfShape, OvershootsAndComesBackWhenItIsTooFastToStop) {
  const Profile sut = Profile::to_target(0, 2.0, 0.1, {1.0, 2.0}, GetParam());
  EXPECT_NEAR(sut.at(1.0).position, 1.0, 1e-12);
  EXPECT_NEAR(sut.at(1.0).velocity, 0.0, 1e-12);
  EXPECT_EQ(sut.at(sut.duration()).position, 0.1);
}

TEST_P(ProfileOfShape, BrakesHarderRatherThanLeaveTheRange) {
  AxisLimits limits{1.0, 2.0, -1.0, 0.3};
  const Profile sut = Profile::to_target(0, 2.0, 0.1, limits, GetParam());
  double furthest = 0;
  for (double t = 0; t < sut.duration(); t += 1e-3) furthest = std::max(furthest, sut.at(t).position);
  EXPECT_NEAR(furthest, 0.3, 1e-5);
  EXPECT_LE(furthest, 0.3);
}

TEST_P(ProfileOfShape, SlowsDownToALowerCruiseAndArrives) {
  const Profile sut = Profile::to_target(0, 2.0, 5.0, {1.0, 2.0}, GetParam());
  EXPECT_NEAR(sut.at(0.5).velocity, 1.0, 1e-12);
  EXPECT_NEAR(sut.at(1.0).velocity, 1.0, 1e-12);
  EXPECT_EQ(sut.at(sut.duration()).position, 5.0);
}

TEST_P(ProfileOfShape, MovingAxisFollowsCommandsThatComeFasterThanARampLasts) {
  // Each new command starts at the velocity that the one before has reached within a millisecond.
  Profile::State state;
  for (int i = 0; i < 400; ++i) {
    const Profile sut = Profile::to_target(state.position, state.velocity, 10.0, {1.2, 4.8}, GetParam());
    state = sut.at(1e-3);
  }
  EXPECT_GT(state.velocity, 1.1);
}

TEST_P(ProfileOfShape, TheSameTargetAgainInTheMiddleOfBrakingDoesNotOvershoot) {
  const Profile first = Profile::to_target(0, 0, 1.0, {1.0, 2.0}, GetParam());
  for (double left = 0.01; left < 0.5; left += 0.01) {
    const Profile::State at = first.at(first.duration() - left);
    const Profile sut = Profile::to_target(at.position, at.velocity, 1.0, {1.0, 2.0}, GetParam());
    for (double t = 0; t <= sut.duration(); t += 1e-3) ASSERT_LE(sut.at(t).position, 1.0 + 1e-9) << left;
    EXPECT_LE(sut.duration(), 0.6);
  }
}

// Everything that has to hold for any start, checked against itself by differences.
TEST_P(ProfileOfShape, RandomStartsKeepTheirLimitsAreSmoothAndArrive) {
  std::mt19937_64 random(42);
  const auto within = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  for (int round = 0; round < 3000; ++round) {
    AxisLimits limits{within(0.1, 3), within(0.2, 10), -2.0, 2.0};
    const double p0 = within(-2, 2);
    const double target = within(-2, 2);
    // As fast as the axis may be there: able to stop within the range.
    const double v0 = round % 3 == 0 ? 0.0 : within(-1, 1) * std::sqrt(2 * limits.acceleration * (2 - std::abs(p0)));
    const Profile sut = Profile::to_target(p0, v0, target, limits, GetParam());
    const double fastest = std::max(limits.velocity, std::abs(v0));
    const double dt = sut.duration() / 257;
    Profile::State before = sut.at(0);
    ASSERT_NEAR(before.position, p0, 1e-12);
    ASSERT_NEAR(before.velocity, sut.duration() > 0 ? v0 : 0.0, 1e-9);
    for (int i = 1; i <= 257; ++i) {
      const Profile::State now = sut.at(dt * i);
      ASSERT_LE(std::abs(now.velocity), fastest * (1 + 1e-12));
      ASSERT_GE(now.position, -2.0 - 1e-12);
      ASSERT_LE(now.position, 2.0 + 1e-12);
      const double steepest = limits.acceleration * (std::numbers::pi / 2) * (1 + 1e-5);
      ASSERT_LE(std::abs(now.velocity - before.velocity), steepest * dt + 1e-12);
      ASSERT_LE(std::abs(now.position - before.position), fastest * dt * (1 + 1e-9) + 1e-12);
      ASSERT_NEAR(now.position - before.position, 0.5 * (now.velocity + before.velocity) * dt,
                  steepest * dt * dt + 1e-12);
      before = now;
    }
    EXPECT_NEAR(before.position, target, 1e-9);
  }
}

TEST_P(ProfileOfShape, ALowerCruiseTakesAsLongAsItIsToldTo) {
  std::mt19937_64 random(7);
  const auto within = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  int stretched = 0;
  for (int round = 0; round < 3000; ++round) {
    AxisLimits limits{within(0.1, 3), within(0.2, 10)};
    const double v0 = round % 3 == 0 ? 0.0 : within(-2, 2);
    const double target = within(-2, 2);
    const double shortest = Profile::to_target(0, v0, target, limits, GetParam()).duration();
    const double wanted = shortest * within(1, 3);
    AxisLimits slower = limits;
    slower.velocity = Profile::velocity_for(wanted, 0, v0, target, limits, GetParam());
    ASSERT_GT(slower.velocity, 0);
    ASSERT_LE(slower.velocity, limits.velocity);
    const double duration = Profile::to_target(0, v0, target, slower, GetParam()).duration();
    if (duration == shortest) continue;  // it brakes all the way
    EXPECT_NEAR(duration, wanted, 1e-6 * wanted) << v0 << " " << target;
    ++stretched;
  }
  EXPECT_GT(stretched, 2500);
}

TEST_P(ProfileOfShape, AccelerationForATimeTakesThatTime) {
  for (const double way : {-0.01, 0.05, 2.0}) {
    for (const double acceleration : {0.5, 4.0}) {
      const AxisLimits limits{.velocity = 0.8, .acceleration = acceleration};
      const double duration = Profile::to_target(0, 0, way, limits, GetParam()).duration();
      EXPECT_NEAR(Profile::acceleration_for(duration, way, 0.8), acceleration, 1e-9 * acceleration);
    }
  }
  EXPECT_TRUE(std::isinf(Profile::acceleration_for(1.0, 1.0, 0.8)));
  EXPECT_EQ(Profile::acceleration_for(1.0, 0.0, 0.8), 0.0);
}

TEST(Profile, BothShapesTakeTheSameTimeAndMeetAtTheEndsOfTheirRamps) {
  const Profile ramp = Profile::to_target(0, 0, 2.0, {1.0, 3.0}, VelocityProfile::ramp);
  const Profile sine = Profile::to_target(0, 0, 2.0, {1.0, 3.0}, VelocityProfile::sine);
  EXPECT_DOUBLE_EQ(ramp.duration(), sine.duration());
  EXPECT_NEAR(ramp.at(1.0 / 3).position, sine.at(1.0 / 3).position, 1e-12);
  EXPECT_NEAR(ramp.at(1.5).position, sine.at(1.5).position, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Shapes, ProfileOfShape, testing::ValuesIn(kShapes),
                         [](const auto& tested) { return tested.param == VelocityProfile::ramp ? "Ramp" : "Sine"; });

}  // namespace
}  // namespace cellmirror::motion
