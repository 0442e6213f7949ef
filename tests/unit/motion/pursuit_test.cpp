// Joints that pursue a value within their own limits.
#include "rt_core/motion/pursuit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace cellmirror::motion {
namespace {

constexpr double kPursuitStep = 0.001;
constexpr double kPursuitRounding = 1e-6;  // of accelerations, from positions of about 1
constexpr PursuitLimits kPursued{.lower = -2, .upper = 2, .velocity = 1.5, .acceleration = 15};

// A joint, and how fast it was at the most.
class Pursuer {
 public:
  explicit Pursuer(double position, const PursuitLimits& limits = kPursued) : position_(position), limits_(limits) {}

  void pursue(double target, double target_velocity) {
    move(motion::pursue({position_, velocity_, target, target_velocity, kPursuitStep}, limits_));
  }
  void brake() { move(motion::brake({.present = position_, .velocity = velocity_, .dt = kPursuitStep}, limits_)); }

  [[nodiscard]] double position() const { return position_; }
  [[nodiscard]] double velocity() const { return velocity_; }
  [[nodiscard]] double greatest_velocity() const { return greatest_velocity_; }
  [[nodiscard]] double greatest_acceleration() const { return greatest_acceleration_; }

 private:
  void move(double next) {
    const double velocity = (next - position_) / kPursuitStep;
    greatest_velocity_ = std::max(greatest_velocity_, std::abs(velocity));
    greatest_acceleration_ = std::max(greatest_acceleration_, std::abs(velocity - velocity_) / kPursuitStep);
    position_ = next;
    velocity_ = velocity;
  }

  double position_;
  PursuitLimits limits_;
  double velocity_ = 0;
  double greatest_velocity_ = 0;
  double greatest_acceleration_ = 0;
};

void expect_within_limits(const Pursuer& sut, const PursuitLimits& limits = kPursued) {
  EXPECT_LE(sut.greatest_velocity(), limits.velocity + 1e-9);
  EXPECT_LE(sut.greatest_acceleration(), limits.acceleration + kPursuitRounding);
}

TEST(Pursuit, ComesFromRestToRestInTheTimeOfATrapezoid) {
  Pursuer sut(0);
  constexpr double kWay = 1;
  // 0.1 s to 1.5 rad/s, the same to rest, the rest of the way at that velocity.
  const double seconds = kWay / kPursued.velocity + kPursued.velocity / kPursued.acceleration;
  int steps = 0;
  while (sut.position() != kWay && steps < 10'000) {
    sut.pursue(kWay, 0);
    EXPECT_LE(sut.position(), kWay + 1e-12);
    ++steps;
  }
  EXPECT_NEAR(steps * kPursuitStep, seconds, 3 * kPursuitStep);
  sut.pursue(kWay, 0);
  EXPECT_EQ(sut.velocity(), 0);
  expect_within_limits(sut);
}

TEST(Pursuit, HasNoLagBehindATargetWithTheSameLimits) {
  Pursuer master(1);
  Pursuer sut(1);
  for (int i = 0; i < 4000; ++i) {
    master.pursue(i < 1500 ? -1.5 : 1.9, 0);
    sut.pursue(master.position(), master.velocity());
    ASSERT_NEAR(sut.position(), master.position(), 1e-9) << i;
  }
  expect_within_limits(sut);
}

TEST(Pursuit, FollowsASineWithoutLagOnceItHasReachedIt) {
  Pursuer sut(-1);
  double worst = 0;
  for (int i = 0; i < 8000; ++i) {
    const double phase = std::numbers::pi * i * kPursuitStep;
    const double slope = (std::sin(phase) - std::sin(phase - std::numbers::pi * kPursuitStep)) / kPursuitStep;
    sut.pursue(0.4 * std::sin(phase), 0.4 * slope);
    if (i > 4000) worst = std::max(worst, std::abs(sut.position() - 0.4 * std::sin(phase)));
  }
  EXPECT_LT(worst, 1e-9);
  expect_within_limits(sut);
}

TEST(Pursuit, BrakesInTimeForTheEndsOfItsRange) {
  Pursuer sut(1.5);
  for (int i = 0; i < 2000; ++i) {
    sut.pursue(5, 3);
    ASSERT_LE(sut.position(), kPursued.upper);
  }
  EXPECT_NEAR(sut.position(), kPursued.upper, 1e-9);
  for (int i = 0; i < 4000; ++i) {
    sut.pursue(-5, -3);
    ASSERT_GE(sut.position(), kPursued.lower);
  }
  EXPECT_NEAR(sut.position(), kPursued.lower, 1e-9);
  expect_within_limits(sut);
}

TEST(Pursuit, StaysWithinItsLimitsWhateverTheTargetDoes) {
  std::mt19937 random(20261129);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same in each run
  std::uniform_real_distribution<double> anywhere(-4, 4);
  std::uniform_int_distribution<int> how_long(1, 200);
  for (int run = 0; run < 50; ++run) {
    Pursuer sut(anywhere(random) / 2);
    for (int i = 0; i < 100; ++i) {
      const double target = anywhere(random);
      const double velocity = anywhere(random);
      const bool known = how_long(random) > 30;
      for (int k = how_long(random); k > 0; --k) known ? sut.pursue(target, velocity) : sut.brake();
      ASSERT_LE(std::abs(sut.position()), 2);
    }
    expect_within_limits(sut);
  }
}

TEST(Pursuit, BrakesToRestWhereTheTargetIsNotKnown) {
  Pursuer sut(0);
  for (int i = 0; i < 200; ++i) sut.pursue(1.9, 0);
  const double began = sut.position();
  for (int i = 0; i < 150; ++i) sut.brake();
  EXPECT_EQ(sut.velocity(), 0);
  EXPECT_NEAR(sut.position() - began, kPursued.velocity * kPursued.velocity / (2 * kPursued.acceleration), 2e-3);
  expect_within_limits(sut);
}

TEST(Pursuit, WithoutAnAccelerationTheVelocityAloneCounts) {
  PursuitLimits limits = kPursued;
  limits.acceleration = std::numeric_limits<double>::infinity();
  Pursuer sut(0, limits);
  sut.pursue(1, 0);
  EXPECT_DOUBLE_EQ(sut.position(), limits.velocity * kPursuitStep);
  sut.pursue(sut.position() + 0.0001, 0);
  EXPECT_DOUBLE_EQ(sut.position(), limits.velocity * kPursuitStep + 0.0001);
  sut.brake();
  EXPECT_EQ(sut.velocity(), 0);
}

TEST(Pursuit, NarrowedRangesCountMoreThanTheAcceleration) {
  EXPECT_EQ(pursue({.present = 1, .velocity = 1.5, .target = 2, .dt = kPursuitStep},
                   {.lower = -2, .upper = 1, .velocity = 1.5, .acceleration = 15}),
            1);
}

TEST(Pursuit, NoTimeMovesNothing) {
  EXPECT_EQ(pursue({.present = 0.5, .velocity = 1, .target = 1, .dt = 0}, kPursued), 0.5);
  EXPECT_EQ(brake({.present = 0.5, .velocity = 1, .dt = 0}, kPursued), 0.5);
}

}  // namespace
}  // namespace cellmirror::motion
