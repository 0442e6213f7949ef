// Poses and Jacobians of our reader and kinematics against those of other libraries with readers of their own.
#include <gtest/gtest.h>

#include <random>

#include "rt_core/cell/robot_chain.hpp"
#include "rt_core/kinematics/forward.hpp"
#include "tests/unit/kinematics/kdl_peer.hpp"
#ifdef CELLMIRROR_HAVE_MUJOCO
#include "tests/unit/kinematics/mujoco_peer.hpp"
#endif
#include "tests/unit/kinematics/shared_arms.hpp"

namespace cellmirror {
namespace {

using kinematics::Chain;
using kinematics::forward;
using kinematics::Jacobian;

constexpr double kAgreed = 1e-9;
constexpr int kPostures = 1000;

std::span<const double> values(const Chain& chain, const JointValues& q) { return {q.data(), chain.variable_count()}; }

double difference(const Pose& a, const Pose& b) { return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff(); }

TEST(ChainAndKdl, agreeOnAllArms) {
  const auto arms = shared_arms();
  if (arms.empty()) GTEST_SKIP() << "skipped: the robots of ../shared/data are not on this machine";
  std::mt19937_64 random(1);
  for (const SharedArm& arm : arms) {
    const Chain sut = chain_of_urdf(arm.urdf, arm.base, arm.tip);
    KdlChain kdl(arm.urdf, arm.base, arm.tip);
    ASSERT_EQ(sut.variable_count(), kdl.joint_count()) << arm.id;
    for (int i = 0; i < kPostures; ++i) {
      const JointValues q = random_posture(sut, random);
      Jacobian jacobian;
      const Pose X_BT = forward(sut, values(sut, q), jacobian);
      EXPECT_LT(difference(X_BT, kdl.forward(q)), kAgreed) << arm.id;
      EXPECT_LT((jacobian - kdl.jacobian(q)).cwiseAbs().maxCoeff(), kAgreed) << arm.id;
    }
  }
}

#ifdef CELLMIRROR_HAVE_MUJOCO
TEST(ChainAndMujoco, agreeOnAllArms) {
  const auto arms = shared_arms();
  if (arms.empty()) GTEST_SKIP() << "skipped: the robots of ../shared/data are not on this machine";
  std::mt19937_64 random(2);
  for (const SharedArm& arm : arms) {
    const Chain sut = chain_of_urdf(arm.urdf, arm.base, arm.tip);
    std::vector<std::string> joints;
    for (const auto& variable : sut.variables()) joints.push_back(variable.name);
    MujocoChain mujoco(arm.urdf, arm.base, arm.tip, joints);
    for (int i = 0; i < kPostures; ++i) {
      const JointValues q = random_posture(sut, random);
      Jacobian jacobian;
      const Pose X_BT = forward(sut, values(sut, q), jacobian);
      mujoco.move_to(q);
      EXPECT_LT(difference(X_BT, mujoco.pose()), kAgreed) << arm.id;
      EXPECT_LT((jacobian - mujoco.jacobian()).cwiseAbs().maxCoeff(), kAgreed) << arm.id;
    }
  }
}
#else
TEST(ChainAndMujoco, agreeOnAllArms) { GTEST_SKIP() << "skipped: libmujoco-dev is not installed"; }
#endif

// Any base and tip: also where the base hangs on the tip, and across branches.
void compare_on_random_trees(bool along_axes, unsigned seed) {
  std::mt19937_64 random(seed);
  constexpr std::size_t kLinks = 14;
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    const std::string urdf = random_urdf(kLinks, along_axes, random);
    std::uniform_int_distribution<int> pick(0, kLinks - 1);
    const std::string base = "L" + std::to_string(pick(random));
    const std::string tip = "L" + std::to_string(pick(random));
    const auto sut = chain_between(component_of_urdf(urdf), base, tip);
    KdlChain kdl(urdf, base, tip);
    ASSERT_EQ(sut.has_value(), kdl.joint_count() > 0) << (sut ? "" : sut.error().text()) << urdf;
    if (!sut) continue;
    ASSERT_EQ(sut->variable_count(), kdl.joint_count());
    ++compared;
    for (int k = 0; k < 10; ++k) {
      const JointValues q = random_posture(*sut, random);
      Jacobian jacobian;
      const Pose X_BT = forward(*sut, values(*sut, q), jacobian);
      ASSERT_LT(difference(X_BT, kdl.forward(q)), kAgreed) << base << " to " << tip << "\n" << urdf;
      ASSERT_LT((jacobian - kdl.jacobian(q)).cwiseAbs().maxCoeff(), kAgreed) << base << " to " << tip << "\n" << urdf;
    }
  }
  EXPECT_GT(compared, 150);
}

TEST(ChainAndKdl, agreeOnRandomTreesOfAnyAxes) { compare_on_random_trees(false, 3); }
TEST(ChainAndKdl, agreeOnRandomTreesAlongTheAxes) { compare_on_random_trees(true, 4); }

TEST(ChainAndKdl, agreeFromTheTipToTheBaseOfAllArms) {
  const auto arms = shared_arms();
  if (arms.empty()) GTEST_SKIP() << "skipped: the robots of ../shared/data are not on this machine";
  std::mt19937_64 random(5);
  for (const SharedArm& arm : arms) {
    const Chain sut = chain_of_urdf(arm.urdf, arm.tip, arm.base);
    KdlChain kdl(arm.urdf, arm.tip, arm.base);
    EXPECT_TRUE(sut.plain()) << arm.id;
    for (int i = 0; i < kPostures / 10; ++i) {
      const JointValues q = random_posture(sut, random);
      EXPECT_LT(difference(forward(sut, values(sut, q)), kdl.forward(q)), kAgreed) << arm.id;
    }
  }
}

}  // namespace
}  // namespace cellmirror
