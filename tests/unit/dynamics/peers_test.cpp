// Efforts of our reader, cell and dynamics against those of other libraries with readers of their own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "rt_core/dynamics/inverse_dynamics.hpp"
#include "tests/unit/dynamics/kdl_dynamics.hpp"
#include "tests/unit/dynamics/peer_arms.hpp"
#ifdef CELLMIRROR_HAVE_MUJOCO
#include "tests/unit/dynamics/mujoco_dynamics.hpp"
#endif

namespace cellmirror::dynamics {
namespace {

constexpr double kAgreed = 1e-8;  // of the greatest effort of the state
constexpr int kStates = 1000;
constexpr const char* kNoArms = "skipped: the robots of ../shared/data are not on this machine";

double coulomb(const Drive& drive, double qd) { return drive.coulomb_friction * std::tanh(qd / kFrictionSpeed); }

// Ours without Coulomb friction.
std::vector<double> efforts(const PeerArm& arm, const DynamicsInput& input) {
  DynamicsOutput output;
  inverse_dynamics(*arm.ours.mechanism, input, output);
  std::vector<double> all;
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    all.push_back(output.effort[i] - coulomb(arm.ours.mechanism->drive(i), input.qd[i]));
  }
  return all;
}

double greatest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

// Of the bare links: KDL has no friction.
double worst_against_kdl(const PeerArm& arm, int states, std::mt19937_64& random) {
  KdlDynamics kdl(arm.urdf, arm.base, arm.tip);
  EXPECT_EQ(kdl.joint_count(), arm.joints.size()) << arm.id;
  double worst = 0;
  for (int i = 0; i < states; ++i) {
    const State state = random_state(arm.joints.size(), random);
    kdl.set(state.q, state.qd, state.qdd);
    kdl.compute(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
    const std::vector<double> ours = efforts(arm, {state.q, state.qd, state.qdd});
    const double scale = greatest(ours);
    for (std::size_t k = 0; k < ours.size(); ++k) {
      Drive drive = arm.ours.mechanism->drive(k);
      drive.coulomb_friction = 0;
      const double bare = ours[k] - drive_effort(drive, state.qd[k], state.qdd[k]);
      worst = std::max(worst, std::abs(bare - kdl.effort(k)) / scale);
    }
  }
  return worst;
}

TEST(DynamicsAndKdl, agreeOnTheArms) {
  const auto arms = arms_with_masses();
  if (arms.empty()) GTEST_SKIP() << kNoArms;
  EXPECT_EQ(arms.size(), 3U);
  std::mt19937_64 random(1);
  for (const PeerArm& arm : arms) EXPECT_LT(worst_against_kdl(arm, kStates, random), kAgreed) << arm.id;
}

TEST(DynamicsAndKdl, agreeOnTheManutec) {
  std::mt19937_64 random(2);
  EXPECT_LT(worst_against_kdl(manutec_r3(15.0), kStates, random), kAgreed);
}

// The Manutec's tip is L6 for KDL, our TCP the hand 0.12 m beyond; DLR's frames have y upwards, ours z.
TEST(DynamicsAndKdl, agreeOnAForceAtTheTip) {
  const PeerArm arm = manutec_r3(15.0);
  KdlDynamics kdl(arm.urdf, arm.base, arm.tip);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> value(-100, 100);
  for (int i = 0; i < kStates; ++i) {
    const State state = random_state(arm.joints.size(), random);
    const Eigen::Vector3d force(value(random), value(random), value(random));
    const Eigen::Vector3d torque(value(random), value(random), value(random));
    DynamicsInput input{state.q, state.qd, state.qdd};
    input.tip_force_T = force;
    input.tip_torque_T = torque;
    const std::vector<double> ours = efforts(arm, input);
    // Ours x, y, z point along DLR's x, -z, y.
    const auto to_dlr = [](const Eigen::Vector3d& v) { return Eigen::Vector3d(v.x(), v.z(), -v.y()); };
    const Eigen::Vector3d about_wrist = torque + Eigen::Vector3d(0, 0, 0.12).cross(force);
    kdl.set(state.q, state.qd, state.qdd);
    kdl.compute(to_dlr(force), to_dlr(about_wrist));
    const double scale = greatest(ours);
    for (std::size_t k = 0; k < ours.size(); ++k) {
      Drive drive = arm.ours.mechanism->drive(k);
      drive.coulomb_friction = 0;
      const double bare = ours[k] - drive_effort(drive, state.qd[k], state.qdd[k]);
      ASSERT_NEAR(bare, kdl.effort(k), kAgreed * scale) << "joint " << k + 1;
    }
  }
}

#ifdef CELLMIRROR_HAVE_MUJOCO
// With rotors and viscous friction.
double worst_against_mujoco(const PeerArm& arm, int states, std::mt19937_64& random) {
  std::vector<Drive> drives;
  for (std::size_t i = 0; i < arm.joints.size(); ++i) drives.push_back(arm.ours.mechanism->drive(i));
  MujocoDynamics mujoco(arm.urdf, arm.joints, drives);
  double worst = 0;
  for (int i = 0; i < states; ++i) {
    const State state = random_state(arm.joints.size(), random);
    mujoco.set(state.q, state.qd, state.qdd);
    mujoco.compute();
    const std::vector<double> ours = efforts(arm, {state.q, state.qd, state.qdd});
    const double scale = greatest(ours);
    for (std::size_t k = 0; k < ours.size(); ++k) {
      worst = std::max(worst, std::abs(ours[k] - mujoco.effort(k)) / scale);
    }
  }
  return worst;
}

TEST(DynamicsAndMujoco, agreeOnTheArms) {
  const auto arms = arms_with_masses();
  if (arms.empty()) GTEST_SKIP() << kNoArms;
  std::mt19937_64 random(4);
  for (const PeerArm& arm : arms) EXPECT_LT(worst_against_mujoco(arm, kStates, random), kAgreed) << arm.id;
}

TEST(DynamicsAndMujoco, agreeOnTheManutec) {
  std::mt19937_64 random(5);
  EXPECT_LT(worst_against_mujoco(manutec_r3(15.0), kStates, random), kAgreed);
}

TEST(DynamicsAndMujoco, agreeOnRandomTrees) {
  std::mt19937_64 random(6);
  for (int i = 0; i < 50; ++i) {
    const PeerArm tree = random_tree(random);
    EXPECT_LT(worst_against_mujoco(tree, 20, random), kAgreed) << tree.urdf;
  }
}
#else
TEST(DynamicsAndMujoco, agreeOnTheArms) { GTEST_SKIP() << "skipped: libmujoco-dev is not installed"; }
#endif

}  // namespace
}  // namespace cellmirror::dynamics
