// An axis of a pan-tilt head in virtual time: it keeps its limits and ends where it is told to.
#include "sim_devices/camera/head_axis.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace cellmirror::sim {
namespace {

constexpr AxisLimits kLimits{-1.0, 2.0, 0.5, 2.0};

TEST(HeadAxis, GoesToItsGoalWithinItsLimitsAndStandsThere) {
  HeadAxis sut(kLimits, 0);
  double before = 0;
  double reached = 0;
  for (double t = 0; t < 4; t += 0.01) {
    sut.step(1.0, 1.0, 0.01);
    EXPECT_LE(std::abs(sut.velocity()), 0.5 + 1e-9);
    EXPECT_LE(std::abs(sut.velocity() - before), 2.0 * 0.01 + 1e-9);
    EXPECT_LE(sut.position(), 1.0 + 1e-4) << "it brakes in time";
    before = sut.velocity();
    if (reached == 0 && std::abs(sut.position() - 1.0) < 1e-3) reached = t;
  }
  // Trapezoid: 1 rad at 0.5 rad/s, and v/a more for both ramps together.
  EXPECT_NEAR(reached, 1.0 / 0.5 + 0.5 / 2.0, 0.1);
  EXPECT_EQ(sut.position(), 1.0);
  EXPECT_EQ(sut.velocity(), 0);
}

TEST(HeadAxis, StaysWithinItsStops) {
  HeadAxis sut(kLimits, -5);
  EXPECT_EQ(sut.position(), -1.0);
  for (int i = 0; i < 1000; ++i) {
    sut.step(9.0, 1.0, 0.01);
    ASSERT_LE(sut.position(), 2.0);
  }
  EXPECT_EQ(sut.position(), 2.0);
}

TEST(HeadAxis, LagsBehindAMovingGoalByNoMoreThanItsBrakingWay) {
  HeadAxis sut(kLimits, 0);
  double goal = 0;
  for (double t = 0; t < 3; t += 0.002) {
    goal += 0.3 * 0.002;
    sut.step(goal, 1.0, 0.002);
    if (t > 1) {
      EXPECT_NEAR(sut.position(), goal, 0.3 * 0.3 / (2 * 2.0) + 0.003);
    }
  }
}

TEST(HeadAxis, ASlowOneTakesLonger) {
  HeadAxis sut(kLimits, 0);
  sut.step(1.0, 0.1, 1.0);
  EXPECT_NEAR(sut.position(), 0.05, 0.01);
}

TEST(HeadAxis, TheSizeOfTheStepsDoesNotMatter) {
  HeadAxis coarse(kLimits, 0);
  HeadAxis fine(kLimits, 0);
  for (int i = 0; i < 10; ++i) coarse.step(0.4, 1.0, 0.1);
  for (int i = 0; i < 1000; ++i) fine.step(0.4, 1.0, 0.001);
  EXPECT_NEAR(coarse.position(), fine.position(), 1e-4);
}

}  // namespace
}  // namespace cellmirror::sim
