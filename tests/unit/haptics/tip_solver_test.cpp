// Priorities of the tip's posture: the place before the orientation, and limits before both.
#include "rt_core/haptics/tip_solver.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace cellmirror::haptics {
namespace {

// Three revolute joints about z with links of 0.3, 0.3 and 0.2 m: in its plane one motion leaves the tip in its place
// and turns it, and that takes all three joints.
kinematics::Chain planar_arm() {
  std::vector<kinematics::ChainJoint> joints(3);
  std::vector<kinematics::Variable> variables;
  for (std::uint8_t i = 0; i < 3; ++i) {
    joints[i].variable = i;
    if (i > 0) joints[i].X_PJ = Pose(Eigen::Translation3d(0.3, 0, 0));
    variables.push_back({"q", JointKind::revolute, -3, 3});
  }
  return kinematics::Chain::make(variables, joints, Pose(Eigen::Translation3d(0.2, 0, 0))).value();
}

// The velocities of the joints that turn the tip by 1 rad and leave it in its place.
Eigen::Vector3d turning(const kinematics::Jacobian& J) {
  const Eigen::RowVector3d x = J.row(0);
  const Eigen::RowVector3d y = J.row(1);
  const Eigen::Vector3d n = x.cross(y).transpose();
  return n / n.sum();
}

class LimitInTheWay : public testing::TestWithParam<int> {};

// `GetParam()`: the joint whose limit ends the turn.
TEST_P(LimitInTheWay, ShortensATurnAsAWholeSoThatTheTipStaysInItsPlace) {
  const auto stopped = static_cast<std::size_t>(GetParam());
  const kinematics::Chain chain = planar_arm();
  const std::array<double, 3> start = {0.4, 0.9, -0.6};
  std::array<double, 3> q = start;
  kinematics::Jacobian J;
  const Pose X_before = kinematics::forward(chain, q, J);
  const Eigen::Vector3d direction = turning(J);
  constexpr double kRoom = 0.03;  // rad, of the joint until its limit
  std::array<double, 3> lower = {-3, -3, -3};
  std::array<double, 3> upper = {3, 3, 3};
  const double towards = direction[GetParam()] > 0 ? 1.0 : -1.0;
  (towards > 0 ? upper : lower)[stopped] = start[stopped] + towards * kRoom;

  TipGoal goal;
  goal.p_BE = X_before.translation();
  goal.R_BE = Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ()) * X_before.linear();
  const TipPosture found = solve_tip(chain, goal, {lower, upper}, q);

  EXPECT_NEAR(q[stopped], start[stopped] + towards * kRoom, 1e-6) << "as far as its limit lets it";
  EXPECT_LT((found.X_BE.translation() - goal.p_BE).norm(), 1e-6);
  EXPECT_TRUE(found.met);
  const Eigen::AngleAxisd turned(Eigen::Matrix3d(found.X_BE.linear() * X_before.linear().transpose()));
  EXPECT_GT(turned.angle() * turned.axis().z(), 0.5 * kRoom / std::abs(direction[GetParam()]));
}

INSTANTIATE_TEST_SUITE_P(Joints, LimitInTheWay, testing::Values(0, 2));

TEST(TipSolver, TurnsAllTheWayWhereNoLimitIs) {
  const kinematics::Chain chain = planar_arm();
  std::array<double, 3> q = {0.4, 0.9, -0.6};
  const Pose X_before = kinematics::forward(chain, q);
  TipGoal goal;
  goal.p_BE = X_before.translation();
  goal.R_BE = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()) * X_before.linear();
  const TipPosture found = solve_tip(chain, goal, {chain.lower(), chain.upper()}, q);
  EXPECT_TRUE(found.met);
  EXPECT_LT(Eigen::AngleAxisd(Eigen::Matrix3d(goal.R_BE * found.X_BE.linear().transpose())).angle(), 1e-3);
}

TEST(TipSolver, AJointThatIsFixedStaysAsItIsAndTheOthersReachThePlace) {
  const kinematics::Chain chain = planar_arm();
  std::array<double, 3> q = {0.4, 0.9, -0.6};
  TipGoal goal;
  goal.p_BE = kinematics::forward(chain, q).translation() + Eigen::Vector3d(0.02, -0.03, 0);
  goal.orient = false;
  const TipPosture found = solve_tip(chain, goal, {chain.lower(), chain.upper(), 0b010}, q);
  EXPECT_TRUE(found.met);
  EXPECT_EQ(q[1], 0.9);
}

}  // namespace
}  // namespace cellmirror::haptics
