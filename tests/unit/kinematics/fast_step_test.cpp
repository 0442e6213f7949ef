#include "rt_core/kinematics/fast_step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "rt_core/kinematics/null_space.hpp"
#include "rt_core/rt/allocation_guard.hpp"
#include "tests/unit/kinematics/chain_support.hpp"

namespace cellmirror::kinematics {
namespace {

using std::numbers::pi;

Chain planar(std::size_t links) {
  const std::vector<DhRow> rows(links, DhRow{.a = 1.0});
  return chain_of_table(rows);
}

// Seven joints with spherical shoulder and wrist.
Chain seven() {
  const std::vector<DhRow> rows = {{0, -pi / 2, 0.36, 0}, {0, pi / 2, 0, 0}, {0, pi / 2, 0.42, 0}, {0, -pi / 2, 0, 0},
                                   {0, -pi / 2, 0.4, 0},  {0, pi / 2, 0, 0}, {0, 0, 0.126, 0}};
  return chain_of_table(rows);
}

std::span<const double> values(const Chain& chain, const JointValues& q) { return {q.data(), chain.variable_count()}; }
std::span<double> values(const Chain& chain, JointValues& q) { return {q.data(), chain.variable_count()}; }

JointValues drawn(const Chain& chain, std::mt19937_64& random, double share = 1.0) {
  JointValues q{};
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    const double middle = 0.5 * (chain.lower()[i] + chain.upper()[i]);
    const double half = 0.5 * share * (chain.upper()[i] - chain.lower()[i]);
    q[i] = std::uniform_real_distribution<double>(middle - half, middle + half)(random);
  }
  return q;
}

TEST(FastSolve, PlanarArmBendsItsElbowByTheLawOfCosines) {
  const Chain chain = planar(2);
  JointValues q = {0.3, 0.5};
  const Pose X_BG = translation(1.2, 0.7, 0);
  const FastResult sut =
      fast_solve(chain, {.position_axes = 0b011, .orientation = OrientationTask::free}, X_BG, values(chain, q), {});
  ASSERT_TRUE(sut.solved);
  EXPECT_NEAR(q[1], std::acos((1.2 * 1.2 + 0.7 * 0.7 - 2.0) / 2.0), 1e-5);
}

TEST(FastSolve, PathOfSevenJointsTakesTwoIterationsAStepAndNoHeap) {
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  const Chain chain = seven();
  JointValues q = {0.1, 0.6, 0.2, -1.2, 0.3, 0.8, 0.1};
  const Pose X_B0 = forward(chain, values(chain, std::as_const(q)));
  const AllocationGuard guard;
  int most = 0;
  for (int tick = 1; tick <= 200; ++tick) {  // 1 ms each at 0.5 m/s
    const Pose X_BG = Pose(Eigen::Translation3d(0, 0.0005 * tick, 0)) * X_B0;
    const FastResult sut = fast_solve(chain, {}, X_BG, values(chain, q), {});
    ASSERT_TRUE(sut.solved) << tick;
    most = std::max(most, sut.iterations);
  }
  EXPECT_LE(most, 2);
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST(FastSolve, NeverLeavesTheLimitsAndNeverClaimsWhatIsNotSo) {
  std::mt19937_64 random(3);
  const Chain wide = seven();
  std::array<double, 7> lower{};
  std::array<double, 7> upper{};
  lower.fill(-1.1);
  upper.fill(0.9);
  const Chain chain = wide.with_limits(lower, upper).value();
  int solved = 0;
  for (int i = 0; i < 500; ++i) {
    const Pose X_BG = forward(wide, values(wide, drawn(wide, random)));  // most are out of these limits
    JointValues q = drawn(chain, random);
    const FastResult sut = fast_solve(chain, {}, X_BG, values(chain, q), {});
    EXPECT_TRUE(chain.within_limits(values(chain, q)));
    const Twist error = pose_error(forward(chain, values(chain, std::as_const(q))), X_BG);
    EXPECT_EQ(sut.solved, error.cwiseAbs().maxCoeff() <= 1e-5);
    solved += sut.solved ? 1 : 0;
  }
  EXPECT_LT(solved, 500);
}

TEST(FastSolve, StartBeyondTheLimitsIsClamped) {
  const Chain chain = planar(2);
  JointValues q = {100.0, -100.0};
  const FastResult sut = fast_solve(chain, {}, translation(5, 0, 0), values(chain, q), {.max_iterations = 1});
  EXPECT_FALSE(sut.solved);
  EXPECT_TRUE(chain.within_limits(values(chain, q)));
}

TEST(FastSolve, StretchedArmConverges) {
  const Chain chain = planar(3);
  JointValues q = {0.4, -0.6, 0.5};
  const FastResult sut = fast_solve(chain, {.orientation = OrientationTask::free}, translation(3, 0, 0),
                                    values(chain, q), {.max_iterations = 100});
  EXPECT_TRUE(sut.solved) << sut.error.transpose();
}

TEST(FastSolve, OutOfReachEndsStretchedTowardsTheTarget) {
  const Chain chain = planar(3);
  JointValues q = {0.4, -0.6, 0.5};
  const FastResult sut = fast_solve(chain, {.orientation = OrientationTask::free}, translation(0, 5, 0),
                                    values(chain, q), {.max_iterations = 200});
  EXPECT_FALSE(sut.solved);
  EXPECT_NEAR(sut.error.head<3>().norm(), 2.0, 1e-2);
}

TEST(FastSolve, SameInputSameOutput) {
  std::mt19937_64 random(5);
  const Chain chain = seven();
  for (int i = 0; i < 50; ++i) {
    const Pose X_BG = forward(chain, values(chain, drawn(chain, random)));
    JointValues first = drawn(chain, random);
    JointValues second = first;
    const FastResult a = fast_solve(chain, {}, X_BG, values(chain, first), {});
    const FastResult b = fast_solve(chain, {}, X_BG, values(chain, second), {});
    EXPECT_EQ(first, second);
    EXPECT_EQ(a.iterations, b.iterations);
  }
}

TEST(FastSolve, NumbersThatAreNotFiniteAreNotSolved) {
  const Chain chain = seven();
  Pose X_BG = Pose::Identity();
  X_BG.translation().x() = std::numeric_limits<double>::quiet_NaN();
  JointValues q{};
  EXPECT_FALSE(fast_solve(chain, {}, X_BG, values(chain, q), {}).solved);
}

TEST(FastSolve, MimicsAndSlidingJointsAreSearchedToo) {
  std::vector<ChainJoint> joints(4);
  for (ChainJoint& joint : joints) joint.X_PJ = translation(0.4, 0, 0);
  joints[1].variable = 1;
  joints[2].variable = 1;  // follows the second at half its angle
  joints[2].multiplier = 0.5;
  joints[3].variable = 2;
  joints[3].kind = JointKind::prismatic;
  joints[3].X_PJ = translation(0.4, 0, 0) * turn(pi / 2, Eigen::Vector3d::UnitY());
  std::vector<Variable> variables = {
      {"a", JointKind::revolute, -2, 2}, {"b", JointKind::revolute, -2, 2}, {"c", JointKind::prismatic, 0, 0.3}};
  const Chain chain = Chain::make(variables, joints, Pose::Identity()).value();
  const JointValues there = {0.7, -0.9, 0.12};
  JointValues q = {0.5, -0.6, 0.2};
  const FastResult sut = fast_solve(chain, {}, forward(chain, values(chain, there)), values(chain, q), {});
  ASSERT_TRUE(sut.solved);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(q[i], there[i], 1e-4);
}

// Every class of rob_inverse_class on a robot that it is meant for: the pose at a posture can always be met.
struct ClassCase {
  InverseClass inverse_class;
  Chain chain;
};

// A vertical column that slides, then a SCARA's or a wrist's three turns.
Chain prrr(bool wrist) {
  std::vector<ChainJoint> joints(4);
  std::vector<Variable> variables;
  for (std::uint8_t i = 0; i < 4; ++i) {
    joints[i].variable = i;
    joints[i].kind = i == 0 ? JointKind::prismatic : JointKind::revolute;
    variables.push_back({"q" + std::to_string(i), joints[i].kind, i == 0 ? 0.0 : -2.5, i == 0 ? 1.0 : 2.5});
  }
  if (wrist) {
    joints[2].X_PJ = turn(pi / 2, Eigen::Vector3d::UnitX());
    joints[3].X_PJ = turn(-pi / 2, Eigen::Vector3d::UnitX());
  } else {
    joints[2].X_PJ = joints[3].X_PJ = translation(0.5, 0, 0);
  }
  return Chain::make(variables, joints, translation(0.1, 0, 0.2)).value();
}

Chain five() {
  const std::vector<DhRow> rows = {
      {0.1, pi / 2, 0.4, 0}, {0.5, 0, 0, 0}, {0.6, 0, 0, 0}, {0.05, pi / 2, 0, pi / 2}, {0, 0, 0.12, 0}};
  return chain_of_table(rows);
}

// A boom in the x-z plane: its joints turn about y.
Chain upright_boom() {
  std::vector<ChainJoint> joints(3);
  std::vector<Variable> variables;
  for (std::uint8_t i = 0; i < 3; ++i) {
    joints[i].variable = i;
    joints[i].X_PJ = i == 0 ? turn(-pi / 2, Eigen::Vector3d::UnitX()) : translation(1, 0, 0);
    variables.push_back({"q" + std::to_string(i), JointKind::revolute, -2.0, 2.0});
  }
  return Chain::make(variables, joints, translation(0.5, 0, 0) * turn(pi / 2, Eigen::Vector3d::UnitX())).value();
}

TEST(FastSolve, EveryClassMeetsWhatItRequiresOnItsKindOfRobot) {
  using enum InverseClass;
  const std::vector<ClassCase> cases = {{align_frame, seven()},
                                        {align_pos, five()},
                                        {align_z_axis, prrr(true)},
                                        {align_xy_axis, prrr(false)},
                                        {align_xz_axis, prrr(false)},
                                        {align_yz_axis, prrr(false)},
                                        {align_x_axis, prrr(false)},
                                        {align_y_axis, prrr(false)},
                                        {align_n_axis, five()},
                                        {align_s_axis, five()},
                                        {align_a_axis, five()},
                                        {align_xz_n_axis, upright_boom()},
                                        {align_xz_a_axis, upright_boom()},
                                        {align_xy_n_axis, planar(3)},
                                        {align_xy_s_axis, planar(3)},
                                        {edith, planar(5)},
                                        {boom_3, planar(3)},
                                        {boom_4, planar(4)},
                                        {boom_5, planar(5)},
                                        {boom_6, planar(6)}};
  std::mt19937_64 random(11);
  for (const ClassCase& one : cases) {
    const Task task = task_of(one.inverse_class, one.chain);
    int met = 0;
    constexpr int kTargets = 40;
    for (int i = 0; i < kTargets; ++i) {
      const JointValues there = drawn(one.chain, random, 0.8);
      const Pose X_BG = forward(one.chain, values(one.chain, there));
      bool solved = false;
      for (int start = 0; start < 80 && !solved; ++start) {
        JointValues q = drawn(one.chain, random);
        solved = fast_solve(one.chain, task, X_BG, values(one.chain, q), {.max_iterations = 60}).solved;
      }
      met += solved ? 1 : 0;
    }
    EXPECT_EQ(met, kTargets) << "class " << static_cast<int>(one.inverse_class);
  }
}

TEST(FastSolve, AttemptedOrientationIsMetWhereThePositionLeavesRoom) {
  const Chain chain = prrr(true);  // height by the slide, any orientation by the wrist
  const Task task = task_of(InverseClass::align_z_axis, chain);
  const JointValues there = {0.6, 0.5, 1.0, -0.7};
  JointValues q = {0.2, 0.1, 0.4, 0.2};
  const FastResult sut =
      fast_solve(chain, task, forward(chain, values(chain, there)), values(chain, q), {.max_iterations = 60});
  EXPECT_TRUE(sut.solved);
  EXPECT_LT(sut.error.tail<3>().norm(), 1e-4) << "all of it can be met";
}

TEST(FastSolve, AttemptedOrientationComesAfterThePosition) {
  const Chain chain = planar(2);
  const Task task = {.position_axes = 0b011, .orientation = OrientationTask::normal, .orientation_required = false};
  const Pose X_BG = translation(1.2, 0.7, 0) * turn(2.0, Eigen::Vector3d::UnitZ());
  JointValues q = {0.3, 0.5};
  const FastResult sut = fast_solve(chain, task, X_BG, values(chain, q), {.max_iterations = 60});
  EXPECT_TRUE(sut.solved);
  EXPECT_LT(sut.error.head<3>().norm(), 2e-5);
  EXPECT_GT(sut.error.tail<3>().norm(), 0.1) << "two joints cannot turn the tool as well";
}

TEST(Settle, FourEqualLinksBendEvenly) {
  const Chain chain = planar(4);
  const Task task = {.position_axes = 0b011, .orientation = OrientationTask::free, .secondary = Secondary::even_bend};
  const Pose X_BG = translation(3.0, 1.0, 0);
  JointValues q = {1.4, -1.6, 1.0, -1.2};
  ASSERT_TRUE(fast_solve(chain, task, X_BG, values(chain, q), {.max_iterations = 60}).solved);
  const JointValues before = q;
  EXPECT_GT(settle(chain, task, X_BG, values(chain, std::as_const(q)), values(chain, q), {.max_steps = 40}), 0);
  EXPECT_TRUE(meets(task, task_error(task, forward(chain, values(chain, std::as_const(q))), X_BG), 1e-5));
  // Stationary: what is left of q after taking out the rows of the task is nothing.
  Jacobian J;
  (void)forward(chain, values(chain, std::as_const(q)), J);
  const Eigen::MatrixXd rows = J.topRows<2>();
  const Eigen::Map<const Eigen::VectorXd> bend(q.data(), 4);
  const Eigen::VectorXd left = bend - rows.transpose() * (rows * rows.transpose()).inverse() * rows * bend;
  EXPECT_LT(left.norm(), 0.02);
  EXPECT_LT(bend.squaredNorm(), Eigen::Map<const Eigen::VectorXd>(before.data(), 4).squaredNorm());
}

TEST(Settle, SevenJointsComeNearerToThePresentPostureAndKeepThePose) {
  std::mt19937_64 random(17);
  const Chain chain = seven();
  for (int i = 0; i < 100; ++i) {
    const JointValues present = drawn(chain, random, 0.8);
    JointValues q = drawn(chain, random, 0.8);
    const Pose X_BG = forward(chain, values(chain, std::as_const(q)));
    const auto away = [&] {
      double sum = 0;
      for (std::size_t k = 0; k < 7; ++k) sum += (q[k] - present[k]) * (q[k] - present[k]);
      return sum;
    };
    const double before = away();
    const int steps = settle(chain, {}, X_BG, values(chain, present), values(chain, q), {});
    EXPECT_LE(away(), before);
    EXPECT_EQ(steps > 0, away() < before);
    EXPECT_TRUE(chain.within_limits(values(chain, q)));
    EXPECT_TRUE(meets({}, pose_error(forward(chain, values(chain, std::as_const(q))), X_BG), 1e-5));
  }
}

TEST(Settle, SixJointsHaveNoChoice) { EXPECT_FALSE(has_choice(planar(6), {})); }

}  // namespace
}  // namespace cellmirror::kinematics
