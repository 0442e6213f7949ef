// Poses of a slow stream, spread over the steps of the simulation.
#include "app/workers/pose_ramp.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace cellmirror::app {
namespace {

Pose at(double x, double angle = 0) {
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  X.translation().x() = x;
  return X;
}

TEST(PoseRamp, AStreamWithAPoseInEachStepPassesThroughToTheBit) {
  PoseRamp ramp;
  for (int i = 0; i < 100; ++i) {
    const Pose X = at(0.001 * i * i, 0.01 * i);
    EXPECT_EQ(ramp.step(X).matrix(), X.matrix()) << i;
  }
}

TEST(PoseRamp, ASlowStreamMovesInEachStepAndIsOnePeriodBehind) {
  PoseRamp ramp;
  constexpr int kPeriod = 8;
  double last = 0;
  for (int i = 0; i < 400; ++i) {
    const double sent = 0.0002 * (i - i % kPeriod);  // 0.2 m/s in steps of 1 ms
    const Pose X = ramp.step(at(sent, 0.5 * sent));
    const double x = X.translation().x();
    if (i > 2 * kPeriod) {
      EXPECT_NEAR(x - last, 0.0002, 1e-12) << i;
      EXPECT_NEAR(x, 0.0002 * (i - kPeriod + 1), 1e-12) << i;
      EXPECT_TRUE(X.linear().isUnitary(1e-12));
    }
    last = x;
  }
}

TEST(PoseRamp, AfterARestItGoesOnWithThePeriodThatItKnows) {
  PoseRamp ramp;
  for (int i = 0; i < 80; ++i) (void)ramp.step(at(0.001 * (i / 8)));
  for (int i = 0; i < 5000; ++i) (void)ramp.step(at(0.009));
  EXPECT_EQ(ramp.step(at(0.009)).translation().x(), 0.009);
  double last = 0.009;
  for (int i = 0; i < 8; ++i) {
    const double x = ramp.step(at(0.017)).translation().x();
    EXPECT_NEAR(x - last, 0.001, 1e-12) << i;
    last = x;
  }
  EXPECT_EQ(last, 0.017);
}

TEST(PoseRamp, WhatIsNotFinitePassesAndIsForgotten) {
  PoseRamp ramp;
  (void)ramp.step(at(0.1));
  EXPECT_TRUE(std::isnan(ramp.step(at(std::numeric_limits<double>::quiet_NaN())).translation().x()));
  EXPECT_EQ(ramp.step(at(0.3)).translation().x(), 0.3);
}

}  // namespace
}  // namespace cellmirror::app
