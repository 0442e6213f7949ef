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

TEST(Limiter, RefusesStepsThatAreFasterThanTheJointMayBe) {
  constexpr std::array kPresent = {0.5, -0.5};
  constexpr std::array kVelocity = {1.0, 0.1};
  constexpr double kTick = 1e-3;
  const auto step = [&](double a, double b) {
    return check_rates(kPresent, std::array{0.5 + a, -0.5 + b}, kVelocity, kTick);
  };
  EXPECT_EQ(step(1e-3, -1e-4), LimiterVerdict::passed);
  EXPECT_EQ(step(0, 0), LimiterVerdict::passed);
  EXPECT_EQ(step(1.01e-3, 0), LimiterVerdict::too_fast);
  EXPECT_EQ(step(0, -1.1e-4), LimiterVerdict::too_fast);
  EXPECT_EQ(step(std::numeric_limits<double>::quiet_NaN(), 0), LimiterVerdict::too_fast);
}

}  // namespace
}  // namespace cellmirror::engine
