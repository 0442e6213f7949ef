#include "rt_core/engine/limiter.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace cellmirror::engine {
namespace {

constexpr std::array<double, 2> kLower = {-1.0, -2.0};
constexpr std::array<double, 2> kUpper = {1.0, 2.0};

LimiterVerdict check(double a, double b) { return check_setpoints(std::array{a, b}, kLower, kUpper); }

TEST(Limiter, PassesWhatLiesWithinTheLimits) {
  EXPECT_EQ(check(0, 0), LimiterVerdict::passed);
  EXPECT_EQ(check(1, -2), LimiterVerdict::passed);
}

TEST(Limiter, RefusesWhatLiesBeyondALimitByMoreThanTheSlack) {
  EXPECT_EQ(check(1.0 + 0.5 * kLimitSlack, 0), LimiterVerdict::passed);
  EXPECT_EQ(check(1.0 + 3 * kLimitSlack, 0), LimiterVerdict::beyond_limit);
  EXPECT_EQ(check(0, -2.0 - 3 * kLimitSlack), LimiterVerdict::beyond_limit);
}

TEST(Limiter, RefusesWhatIsNotFinite) {
  EXPECT_EQ(check(std::numeric_limits<double>::quiet_NaN(), 0), LimiterVerdict::not_finite);
  EXPECT_EQ(check(0, std::numeric_limits<double>::infinity()), LimiterVerdict::not_finite);
}

TEST(Limiter, LooksAtTheValuesThatThereAreAndNotPastTheEnd) {
  const std::array values = {0.0, 0.0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(check_setpoints(std::span(values).first(2), kLower, kUpper), LimiterVerdict::passed);
  EXPECT_EQ(check_setpoints(std::span(values).first(0), {}, {}), LimiterVerdict::passed);
}

constexpr double kTick = 1e-3;

LimiterVerdict check_way(double way, const RateLimits& limits, const JointRate& before = {}) {
  JointRate now;
  return check_step({.present = 0.5, .next = 0.5 + way, .dt = kTick, .before = before}, limits, now);
}

TEST(Limiter, RefusesStepsThatAreFasterThanTheJointMayBe) {
  const RateLimits limits{.velocity = 1.0};
  EXPECT_EQ(check_way(1e-3, limits), LimiterVerdict::passed);
  EXPECT_EQ(check_way(-1e-3, limits), LimiterVerdict::passed);
  EXPECT_EQ(check_way(0, limits), LimiterVerdict::passed);
  EXPECT_EQ(check_way(1.01e-3, limits), LimiterVerdict::too_fast);
  EXPECT_EQ(check_way(-1.01e-3, limits), LimiterVerdict::too_fast);
  EXPECT_EQ(check_way(std::numeric_limits<double>::quiet_NaN(), limits), LimiterVerdict::not_finite);
  EXPECT_EQ(check_way(0, {.velocity = std::numeric_limits<double>::quiet_NaN()}), LimiterVerdict::too_fast);
}

TEST(Limiter, RefusesAStepBeyondTheAccelerationWhereOneIsGiven) {
  const RateLimits limits{.acceleration = 2.0};
  EXPECT_EQ(check_way(2.0 * kTick * kTick, limits), LimiterVerdict::passed);
  EXPECT_EQ(check_way(3.0 * kTick * kTick, limits), LimiterVerdict::beyond_acceleration);
  // From 1 rad/s: neither at once to rest, nor on faster than 2 rad/s2.
  const JointRate cruising{.velocity = 1.0};
  EXPECT_EQ(check_way(1.0 * kTick, limits, cruising), LimiterVerdict::passed);
  EXPECT_EQ(check_way((1.0 - 2.0 * kTick) * kTick, limits, cruising), LimiterVerdict::passed);
  EXPECT_EQ(check_way(0, limits, cruising), LimiterVerdict::beyond_acceleration);
  EXPECT_EQ(check_way((1.0 + 4.0 * kTick) * kTick, limits, cruising), LimiterVerdict::beyond_acceleration);
  EXPECT_EQ(check_way(0, {.acceleration = std::numeric_limits<double>::quiet_NaN()}),
            LimiterVerdict::beyond_acceleration);
}

TEST(Limiter, RefusesAStepBeyondTheJerkWhereOneIsGiven) {
  const RateLimits limits{.jerk = 100.0};
  const JointRate accelerating{.velocity = 1.0, .acceleration = 5.0};
  const auto way_with = [&](double acceleration) { return (1.0 + acceleration * kTick) * kTick; };
  EXPECT_EQ(check_way(way_with(5.0), limits, accelerating), LimiterVerdict::passed);
  EXPECT_EQ(check_way(way_with(5.09), limits, accelerating), LimiterVerdict::passed);
  EXPECT_EQ(check_way(way_with(6.5), limits, accelerating), LimiterVerdict::beyond_jerk);
  EXPECT_EQ(check_way(way_with(3.5), limits, accelerating), LimiterVerdict::beyond_jerk);
}

TEST(Limiter, TellsTheRateOfAStepThatPassed) {
  JointRate now;
  ASSERT_EQ(check_step({.present = 0.0, .next = 2e-3, .dt = kTick, .before = {.velocity = 1.5}}, {}, now),
            LimiterVerdict::passed);
  EXPECT_NEAR(now.velocity, 2.0, 1e-9);
  EXPECT_NEAR(now.acceleration, 500.0, 1e-6);
}

TEST(Limiter, WithoutTimeNothingMoves) {
  JointRate now;
  const RateLimits limits{.velocity = 1.0, .acceleration = 1.0, .jerk = 1.0};
  EXPECT_EQ(check_step({.present = 0.5, .next = 0.5, .dt = 0}, limits, now), LimiterVerdict::passed);
  EXPECT_EQ(check_step({.present = 0.5, .next = 0.51, .dt = 0}, limits, now), LimiterVerdict::too_fast);
}

}  // namespace
}  // namespace cellmirror::engine
