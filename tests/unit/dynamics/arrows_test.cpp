#include "rt_core/dynamics/arrows.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

namespace cellmirror::dynamics {
namespace {

using Eigen::Vector3d;

// A joint that turns about z, at (1, 2, 3), turned by a quarter about z: its x is the world's y.
ForceState one_joint() {
  JointForce joint;
  joint.wrench_J = {{10, 20, 30}, {1, 2, 3}};
  joint.X_WJ.translation() = Vector3d(1, 2, 3);
  joint.X_WJ.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitZ()).toRotationMatrix();
  RobotForces robot;
  robot.joints.push_back(joint);
  robot.tcp_T.force = Vector3d(0, 0, -5);
  robot.tcp_known = true;
  robot.X_WT.translation() = Vector3d(7, 8, 9);
  ForceState state;
  state.robots.push_back(robot);
  return state;
}

TEST(ForceArrows, noneWhereNoneAreWanted) { EXPECT_TRUE(force_arrows({}, one_joint()).empty()); }

TEST(ForceArrows, ofOneComponentInTheJointsFrame) {
  const auto arrows = force_arrows({.joint_forces = ArrowComponent::x}, one_joint());
  ASSERT_EQ(arrows.size(), 1U);
  EXPECT_FALSE(arrows[0].torque);
  EXPECT_TRUE(arrows[0].from_m.isApprox(Vector3d(1, 2, 3)));
  EXPECT_TRUE(arrows[0].vector.isApprox(Vector3d(0, 10, 0)));
}

TEST(ForceArrows, resultantsOfForceAndTorque) {
  const auto arrows = force_arrows(
      {.joint_forces = ArrowComponent::resultant, .joint_torques = ArrowComponent::resultant}, one_joint());
  ASSERT_EQ(arrows.size(), 2U);
  EXPECT_TRUE(arrows[0].vector.isApprox(Vector3d(-20, 10, 30)));
  EXPECT_TRUE(arrows[1].vector.isApprox(Vector3d(-2, 1, 3)));
  EXPECT_TRUE(arrows[1].torque);
}

TEST(ForceArrows, ofTheTcp) {
  ForceState state = one_joint();
  const ForceArrowSettings settings{.tcp_force = ArrowComponent::z};
  const auto arrows = force_arrows(settings, state);
  ASSERT_EQ(arrows.size(), 1U);
  EXPECT_TRUE(arrows[0].from_m.isApprox(Vector3d(7, 8, 9)));
  EXPECT_TRUE(arrows[0].vector.isApprox(Vector3d(0, 0, -5)));
  state.robots[0].tcp_known = false;
  EXPECT_TRUE(force_arrows(settings, state).empty());
}

TEST(ForceArrows, motorsOnlyShowsWhatActsAboutOrAlongTheAxis) {
  ForceState state = one_joint();
  const ForceArrowSettings settings{
      .joint_forces = ArrowComponent::resultant, .joint_torques = ArrowComponent::x, .motors_only = true};
  auto arrows = force_arrows(settings, state);
  ASSERT_EQ(arrows.size(), 1U);
  EXPECT_TRUE(arrows[0].torque);
  EXPECT_TRUE(arrows[0].vector.isApprox(Vector3d(0, 0, 3)));
  state.robots[0].joints[0].kind = JointKind::prismatic;
  state.robots[0].joints[0].axis_J = Vector3d::UnitX();
  arrows = force_arrows(settings, state);
  ASSERT_EQ(arrows.size(), 1U);
  EXPECT_FALSE(arrows[0].torque);
  EXPECT_TRUE(arrows[0].vector.isApprox(Vector3d(0, 10, 0)));
}

TEST(ForceArrows, leavesOutWhatIsNothingOrNoNumber) {
  ForceState state = one_joint();
  state.robots[0].joints[0].wrench_J.force = Vector3d(0, 1, 0);
  EXPECT_TRUE(force_arrows({.joint_forces = ArrowComponent::x}, state).empty());
  state.robots[0].joints[0].wrench_J.force = Vector3d(std::nan(""), 1, 0);
  EXPECT_TRUE(force_arrows({.joint_forces = ArrowComponent::resultant}, state).empty());
}

}  // namespace
}  // namespace cellmirror::dynamics
