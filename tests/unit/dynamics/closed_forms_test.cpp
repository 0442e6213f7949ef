// Inverse dynamics against what textbooks say of mechanisms that one can write down.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "rt_core/dynamics/inverse_dynamics.hpp"
#include "rt_core/rt/allocation_guard.hpp"
#include "tests/unit/dynamics/mechanisms.hpp"

namespace cellmirror::dynamics {
namespace {

using Eigen::Vector3d;

constexpr double kG = 9.80665;

// State, one value a variable.
struct Motion {
  std::vector<double> q;
  std::vector<double> qd;
  std::vector<double> qdd;
  [[nodiscard]] DynamicsInput input() const { return {q, qd, qdd}; }
};

DynamicsOutput computed(const Mechanism& sut, const Motion& motion) {
  DynamicsOutput output;
  inverse_dynamics(sut, motion.input(), output);
  return output;
}

TEST(InverseDynamics, ofAPendulum) {
  constexpr double kMass = 1.7;
  constexpr double kLength = 0.6;
  Link link;
  link.axis = Vector3d::UnitY();
  link.inertia = point_mass(kMass, {0, 0, -kLength});
  const Mechanism sut = made({link});
  for (const double q : {-3.0, -0.4, 0.0, 0.7, 2.0}) {
    const DynamicsOutput output = computed(sut, {{q}, {2.5}, {-1.3}});
    EXPECT_NEAR(output.effort[0], kMass * kLength * kLength * -1.3 + kMass * kG * kLength * std::sin(q), 1e-12);
    // Towards the axis: the centripetal force and what of the weight lies along the rod (J's z points from the mass to
    // the axis).
    EXPECT_NEAR(output.joint_wrench[0].force.z(), kMass * (2.5 * 2.5 * kLength + kG * std::cos(q)), 1e-12);
  }
}

// Craig, Introduction to Robotics, 6.7: point masses at the ends of two links in a vertical plane.
TEST(InverseDynamics, ofATwoLinkArm) {
  constexpr double kM1 = 3.0;
  constexpr double kM2 = 1.5;
  constexpr double kL1 = 0.8;
  constexpr double kL2 = 0.5;
  std::vector<Link> links(2);
  // Craig's plane is x, y with gravity along -y; here the first joint's frame has its y upwards.
  links[0].X_PJ.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitX()).toRotationMatrix();
  links[0].inertia = point_mass(kM1, {kL1, 0, 0});
  links[1].parent = 0;
  links[1].variable = 1;
  links[1].X_PJ.translation() = Vector3d(kL1, 0, 0);
  links[1].inertia = point_mass(kM2, {kL2, 0, 0});
  const Mechanism sut = made(links);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> value(-3, 3);
  for (int i = 0; i < 100; ++i) {
    const Motion motion{{value(random), value(random)}, {value(random), value(random)}, {value(random), value(random)}};
    const auto [q1, q2] = std::pair(motion.q[0], motion.q[1]);
    const auto [w1, w2] = std::pair(motion.qd[0], motion.qd[1]);
    const auto [a1, a2] = std::pair(motion.qdd[0], motion.qdd[1]);
    const double c2 = std::cos(q2);
    const double s2 = std::sin(q2);
    const double tau1 = kM2 * kL2 * kL2 * (a1 + a2) + kM2 * kL1 * kL2 * c2 * (2 * a1 + a2) +
                        (kM1 + kM2) * kL1 * kL1 * a1 - kM2 * kL1 * kL2 * s2 * w2 * w2 -
                        2 * kM2 * kL1 * kL2 * s2 * w1 * w2 + kM2 * kL2 * kG * std::cos(q1 + q2) +
                        (kM1 + kM2) * kL1 * kG * std::cos(q1);
    const double tau2 = kM2 * kL1 * kL2 * c2 * a1 + kM2 * kL1 * kL2 * s2 * w1 * w1 +
                        kM2 * kL2 * kG * std::cos(q1 + q2) + kM2 * kL2 * kL2 * (a1 + a2);
    const DynamicsOutput output = computed(sut, motion);
    EXPECT_NEAR(output.effort[0], tau1, 1e-11);
    EXPECT_NEAR(output.effort[1], tau2, 1e-11);
  }
}

// Craig, 6.9 (example 6.5): a turning joint that carries a sliding one, with moments of inertia.
TEST(InverseDynamics, ofAPolarManipulator) {
  constexpr double kM1 = 2.0;
  constexpr double kM2 = 4.0;
  constexpr double kL1 = 0.3;
  constexpr double kI1 = 0.2;
  constexpr double kI2 = 0.5;
  std::vector<Link> links(2);
  links[0].X_PJ.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitX()).toRotationMatrix();
  links[0].inertia = {kM1, {kL1, 0, 0}, Eigen::Vector3d(0.1, 0.15, kI1).asDiagonal()};
  links[1].parent = 0;
  links[1].variable = 1;
  links[1].kind = JointKind::prismatic;
  links[1].axis = Vector3d::UnitX();
  links[1].inertia = {kM2, Vector3d::Zero(), Eigen::Vector3d(0.3, 0.4, kI2).asDiagonal()};
  const Mechanism sut = made(links);
  const Motion motion{{0.4, 0.9}, {1.1, -0.7}, {0.5, 2.0}};
  const double theta = motion.q[0];
  const double d = motion.q[1];
  const double tau = (kM1 * kL1 * kL1 + kI1 + kI2 + kM2 * d * d) * motion.qdd[0] +
                     2 * kM2 * d * motion.qd[0] * motion.qd[1] + (kM1 * kL1 + kM2 * d) * kG * std::cos(theta);
  const double force = kM2 * motion.qdd[1] - kM2 * d * motion.qd[0] * motion.qd[0] + kM2 * kG * std::sin(theta);
  const DynamicsOutput output = computed(sut, motion);
  EXPECT_NEAR(output.effort[0], tau, 1e-12);
  EXPECT_NEAR(output.effort[1], force, 1e-12);
}

TEST(InverseDynamics, ofALift) {
  Link link;
  link.kind = JointKind::prismatic;
  link.inertia = point_mass(12.0, {0.3, 0.1, 0});
  const Mechanism sut = made({link}, 0);
  Motion motion{{0.5}, {1.0}, {2.0}};
  EXPECT_NEAR(computed(sut, motion).effort[0], 12.0 * (kG + 2.0), 1e-12);
  DynamicsInput input = motion.input();
  input.tip_force_T = Vector3d(0, 0, -50);  // something stands on it
  DynamicsOutput output;
  inverse_dynamics(sut, input, output);
  EXPECT_NEAR(output.effort[0], 12.0 * (kG + 2.0) + 50, 1e-12);
  // The base bears the whole weight, beside the axis.
  EXPECT_NEAR(output.joint_wrench[0].torque.x(), 0.1 * 12.0 * (kG + 2.0), 1e-12);
  EXPECT_NEAR(output.joint_wrench[0].torque.y(), -0.3 * 12.0 * (kG + 2.0), 1e-12);
  // Nothing pulls where nothing weighs.
  input = motion.input();
  input.gravity_B.setZero();
  inverse_dynamics(sut, input, output);
  EXPECT_NEAR(output.effort[0], 24.0, 1e-12);
}

TEST(InverseDynamics, countsTheDrive) {
  Link link;
  link.axis = Vector3d::UnitX();
  const Drive drive{-105.0, 1.3e-3, 42.0, 9.0, 0};
  const Mechanism sut = made({link}, 0, {drive});
  const double rotor = 105.0 * 105.0 * 1.3e-3;
  EXPECT_NEAR(computed(sut, {{0}, {0}, {2}}).effort[0], 2 * rotor, 1e-12);
  EXPECT_NEAR(computed(sut, {{0}, {0.5}, {0}}).effort[0], 42.0 + 4.5, 1e-9);
  EXPECT_NEAR(computed(sut, {{0}, {-0.5}, {0}}).effort[0], -42.0 - 4.5, 1e-9);
  EXPECT_NEAR(computed(sut, {{0}, {kFrictionSpeed}, {0}}).effort[0], 42.0 * std::tanh(1.0) + 9.0 * kFrictionSpeed,
              1e-12);
  EXPECT_EQ(computed(sut, {{0}, {0}, {0}}).effort[0], 0.0);
  // Friction and rotor are the drive's: what stands between the parts is the bare link's.
  EXPECT_EQ(computed(sut, {{0}, {0.5}, {2}}).joint_wrench[0].torque.x(), 0.0);
}

// A gripper whose second finger mimics the first against its sense, twice as fast, and lifts a mass besides.
TEST(InverseDynamics, putsAMimicOnItsVariable) {
  std::vector<Link> links(2);
  links[0].kind = JointKind::prismatic;
  links[0].axis = Vector3d::UnitX();
  links[0].inertia = point_mass(0.2, Vector3d::Zero());
  links[1].kind = JointKind::prismatic;
  links[1].axis = Vector3d(1, 0, 1).normalized();
  links[1].multiplier = -2.0;
  links[1].offset = 0.1;
  links[1].inertia = point_mass(0.3, Vector3d::Zero());
  const Mechanism sut = made(links, -1, {Drive{}});
  const double effort = computed(sut, {{0.3}, {0.4}, {1.5}}).effort[0];
  EXPECT_NEAR(effort, 0.2 * 1.5 + 4 * 0.3 * 1.5 - 2 * 0.3 * kG * std::sqrt(0.5), 1e-12);
}

TEST(InverseDynamics, aPayloadIsLikeItsWeightAtTheTip) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 20; ++i) {
    const RandomMechanism bare(random);
    const Motion still{bare.values(random), std::vector<double>(bare.variables, 0.0),
                       std::vector<double>(bare.variables, 0.0)};
    const auto held = bare.mechanism.with_payload(point_mass(7.0, Vector3d::Zero()));
    ASSERT_TRUE(held);
    EXPECT_NEAR(held->moving_mass(), bare.mechanism.moving_mass() + 7.0, 1e-12);
    const DynamicsOutput with_mass = computed(*held, still);
    DynamicsInput input = still.input();
    const Eigen::Matrix3d R_WT =
        bare.X_WL(bare.mechanism.tip_link(), still.q).linear() * bare.mechanism.X_LT().linear();
    input.tip_force_T = R_WT.transpose() * (7.0 * input.gravity_B);
    DynamicsOutput with_force;
    inverse_dynamics(bare.mechanism, input, with_force);
    for (std::size_t k = 0; k < bare.variables; ++k) EXPECT_NEAR(with_mass.effort[k], with_force.effort[k], 1e-9);
  }
}

// The power of the efforts is the growth of kinetic and potential energy, whatever the mechanism.
TEST(InverseDynamics, keepsEnergy) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 50; ++i) {
    const RandomMechanism arm(random);
    const std::vector<double> middle = arm.values(random);
    const std::vector<double> width = arm.values(random);
    const std::vector<double> pace = arm.values(random);
    const auto at = [&](double t) {
      Motion motion;
      for (std::size_t k = 0; k < arm.variables; ++k) {
        motion.q.push_back(middle[k] + width[k] * std::sin(pace[k] * t));
        motion.qd.push_back(width[k] * pace[k] * std::cos(pace[k] * t));
        motion.qdd.push_back(-width[k] * pace[k] * pace[k] * std::sin(pace[k] * t));
      }
      return motion;
    };
    constexpr double kStep = 1e-4;
    const double t = 0.37;
    const Motion now = at(t);
    const DynamicsOutput output = computed(arm.mechanism, now);
    double power = 0;
    for (std::size_t k = 0; k < arm.variables; ++k) power += output.effort[k] * now.qd[k];
    const Motion before = at(t - kStep);
    const Motion after = at(t + kStep);
    const double growth = (arm.energy(after.q, after.qd) - arm.energy(before.q, before.qd)) / (2 * kStep);
    EXPECT_NEAR(power, growth, 1e-5 * (1.0 + std::abs(power))) << "mechanism " << i;
  }
}

// The mass matrix, a column by one unit acceleration each, is symmetric and positive.
TEST(InverseDynamics, givesASymmetricMassMatrix) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 50; ++i) {
    const RandomMechanism arm(random);
    const auto n = static_cast<Eigen::Index>(arm.variables);
    const std::vector<double> q = arm.values(random);
    Eigen::MatrixXd M(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      Motion motion{q, std::vector<double>(arm.variables, 0.0), std::vector<double>(arm.variables, 0.0)};
      motion.qdd[static_cast<std::size_t>(k)] = 1.0;
      DynamicsInput input = motion.input();
      input.gravity_B.setZero();
      DynamicsOutput output;
      inverse_dynamics(arm.mechanism, input, output);
      for (Eigen::Index r = 0; r < n; ++r) M(r, k) = output.effort[static_cast<std::size_t>(r)];
    }
    EXPECT_LT((M - M.transpose()).cwiseAbs().maxCoeff(), 1e-10 * M.cwiseAbs().maxCoeff());
    EXPECT_GT(M.ldlt().vectorD().minCoeff(), 0.0);
  }
}

TEST(InverseDynamics, leavesTheHeapAlone) {
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  std::mt19937_64 random(6);
  const RandomMechanism arm(random);
  const Motion motion{arm.values(random), arm.values(random), arm.values(random)};
  DynamicsOutput output;
  const AllocationGuard guard;
  inverse_dynamics(arm.mechanism, motion.input(), output);
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(guard.frees(), 0U);
}

}  // namespace
}  // namespace cellmirror::dynamics
