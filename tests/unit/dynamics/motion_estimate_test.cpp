#include "rt_core/dynamics/motion_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace cellmirror::dynamics {
namespace {

Timestamp at_s(double seconds) { return Timestamp{1'000'000'000 + static_cast<std::int64_t>(seconds * 1e9)}; }

// One joint that swings with amplitude 1 and 1 rad/s.
void swing(MotionEstimate& sut, double until, double period, bool tells_velocity, bool differences) {
  for (double t = 0; t <= until; t += period) {
    const std::vector<double> position{std::sin(t) * 0.3};
    const std::vector<double> velocity{tells_velocity ? std::cos(t) * 0.3 : 0.0};
    sut.take(at_s(t), position, velocity, differences);
  }
}

TEST(MotionEstimate, takesVelocitiesThatAreToldAndDerivesAccelerations) {
  MotionEstimate sut;
  swing(sut, 1.5, 1e-3, true, true);
  EXPECT_NEAR(sut.velocity()[0], 0.3 * std::cos(1.5), 1e-3);
  // Behind by the time constant: 0.02 s.
  EXPECT_NEAR(sut.acceleration()[0], -0.3 * std::sin(1.5 - MotionEstimate::kTimeConstant), 1e-3);
}

TEST(MotionEstimate, derivesVelocitiesWhereNoneAreTold) {
  MotionEstimate sut;
  swing(sut, 1.5, 0.01, false, true);
  EXPECT_NEAR(sut.velocity()[0], 0.3 * std::cos(1.5 - MotionEstimate::kTimeConstant), 5e-3);
  EXPECT_NEAR(sut.acceleration()[0], -0.3 * std::sin(1.5 - 2 * MotionEstimate::kTimeConstant), 1e-2);
}

// A simulated robot that is put elsewhere has no velocity, whatever its positions do.
TEST(MotionEstimate, derivesNothingWhereItMayNot) {
  MotionEstimate sut;
  swing(sut, 1.5, 1e-3, false, false);
  EXPECT_EQ(sut.velocity()[0], 0.0);
  EXPECT_EQ(sut.acceleration()[0], 0.0);
}

TEST(MotionEstimate, beginsAnewAfterAJumpOrAGap) {
  const std::vector<double> zero{0.0};
  const std::vector<double> far{1.0};
  const std::vector<double> near{0.1};
  MotionEstimate sut;
  sut.take(at_s(0), zero, zero, true);
  sut.take(at_s(0.01), far, zero, true);
  EXPECT_EQ(sut.velocity()[0], 0.0);
  sut.take(at_s(0.02), {far}, zero, true);
  sut.take(at_s(5), near, zero, true);
  EXPECT_EQ(sut.velocity()[0], 0.0);
  swing(sut, 0.5, 0.01, false, true);  // an earlier instant
  EXPECT_NE(sut.velocity()[0], 0.0);
  sut.stand_still();
  EXPECT_EQ(sut.velocity()[0], 0.0);
  EXPECT_EQ(sut.acceleration()[0], 0.0);
}

TEST(MotionEstimate, theSameInstantChangesNothing) {
  MotionEstimate sut;
  swing(sut, 0.5, 0.01, true, true);
  const double before = sut.acceleration()[0];
  const std::vector<double> position{0.3 * std::sin(0.5)};
  const std::vector<double> velocity{0.2};
  sut.take(at_s(0.5), position, velocity, true);
  sut.take(at_s(0.5), position, velocity, true);
  EXPECT_NEAR(sut.acceleration()[0], before, 5.0);
  const double after = sut.acceleration()[0];
  sut.take(at_s(0.5), position, velocity, true);
  EXPECT_EQ(sut.acceleration()[0], after);
}

}  // namespace
}  // namespace cellmirror::dynamics
