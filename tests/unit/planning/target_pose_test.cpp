// The Cartesian modes of POS_ROB, worked out by hand.
#include <gtest/gtest.h>

#include <numbers>

#include "rt_core/planning/move_planner.hpp"

namespace cellmirror::planning {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;

void expect_pose(const Pose& actual, const Eigen::Vector3d& p, const Eigen::Matrix3d& R) {
  EXPECT_LT((actual.translation() - p).norm(), 1e-12) << actual.translation().transpose();
  EXPECT_LT((actual.linear() - R).norm(), 1e-12) << actual.linear();
}

// The tool looks down: roll of 180 degrees, at (1, 2, 3).
const Pose kDown = pose_from_xyz_rpy({1, 2, 3}, {std::numbers::pi, 0, 0});
const Eigen::Matrix3d kNoScreen = Eigen::Matrix3d::Identity();

TEST(TargetPose, FrameAbsIsThePoseItself) {
  const Pose given = pose_from_xyz_rpy({4, 5, 6}, {0.1, 0.2, 0.3});
  expect_pose(target_pose(TargetMode::frame_abs, given, kDown, kNoScreen), given.translation(), given.linear());
}

TEST(TargetPose, FrameIncAddsInTheAxesOfTheZpFrameAndTurnsAboutTheTcp) {
  const Pose given = pose_from_xyz_rpy({0.1, 0.2, 0.3}, {0, 0, kQuarter});
  const Eigen::Matrix3d R = rotation_from_rpy(0, 0, kQuarter) * rotation_from_rpy(std::numbers::pi, 0, 0);
  expect_pose(target_pose(TargetMode::frame_inc, given, kDown, kNoScreen), {1.1, 2.2, 3.3}, R);
}

TEST(TargetPose, ToolIncAddsInTheAxesOfTheTcp) {
  const Pose given = pose_from_xyz_rpy({0.1, 0.2, 0.3}, {0, 0, kQuarter});
  const Eigen::Matrix3d R = rotation_from_rpy(std::numbers::pi, 0, 0) * rotation_from_rpy(0, 0, kQuarter);
  expect_pose(target_pose(TargetMode::tool_inc, given, kDown, kNoScreen), {1.1, 1.8, 2.7}, R);
}

TEST(TargetPose, ScreenIncAddsAndTurnsInTheAxesOfTheScreen) {
  // Looked at along +y with z up: the screen's x is x, its y is z, its z is -y.
  Eigen::Matrix3d R_ZS;
  R_ZS << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  const Pose given = pose_from_xyz_rpy({0.1, 0.2, 0.3}, {0, 0, kQuarter});
  // A quarter turn about the screen's z is one about -y.
  const Eigen::Matrix3d R = rotation_from_rpy(0, -kQuarter, 0) * rotation_from_rpy(std::numbers::pi, 0, 0);
  expect_pose(target_pose(TargetMode::screen_inc, given, kDown, R_ZS), {1.1, 1.7, 3.2}, R);
}

TEST(TargetPose, ManyIncrementsKeepARotation) {
  const Pose given = pose_from_xyz_rpy({0, 0, 0}, {0.001, 0.002, 0.003});
  Pose X = kDown;
  for (int i = 0; i < 100'000; ++i) X = target_pose(TargetMode::tool_inc, given, X, kNoScreen);
  EXPECT_LT((X.linear().transpose() * X.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

}  // namespace
}  // namespace cellmirror::planning
