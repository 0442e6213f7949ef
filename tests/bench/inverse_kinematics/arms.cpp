#include "tests/bench/inverse_kinematics/arms.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <span>

#include "tests/unit/kinematics/shared_arms.hpp"

namespace cellmirror::test_arms {

namespace {

using kinematics::Chain;
using kinematics::ChainJoint;
using kinematics::Variable;

constexpr double kPi = std::numbers::pi;

// One row of Denavit-Hartenberg parameters (standard form): theta or d is the joint.
struct DhRow {
  double a = 0;
  double alpha = 0;
  double d = 0;
  double theta = 0;
  double lower = -kPi;
  double upper = kPi;
  JointKind kind = JointKind::revolute;
};

Arm arm_from_dh(const std::string& name, std::span<const DhRow> rows) {
  std::vector<Variable> variables;
  std::vector<ChainJoint> joints;
  Pose X = Pose::Identity();
  for (const DhRow& row : rows) {
    ChainJoint joint;
    joint.kind = row.kind;
    joint.variable = static_cast<std::uint8_t>(joints.size());
    joint.X_PJ = X * Pose(Eigen::AngleAxisd(row.theta, Eigen::Vector3d::UnitZ()));
    joints.push_back(joint);
    variables.push_back(
        {.name = "j" + std::to_string(joints.size()), .kind = row.kind, .lower = row.lower, .upper = row.upper});
    X = Pose(Eigen::Translation3d(0, 0, row.d) * Eigen::Translation3d(row.a, 0, 0) *
             Eigen::AngleAxisd(row.alpha, Eigen::Vector3d::UnitX()));
  }
  return {name, Chain::make(std::move(variables), joints, X).value()};
}

Arm universal(const std::string& name, double d1, double a2, double a3, double d4, double d5, double d6) {
  constexpr double kRange = 2 * kPi;
  const std::array<DhRow, 6> rows = {{{0, kPi / 2, d1, 0, -kRange, kRange},
                                      {a2, 0, 0, 0, -kRange, kRange},
                                      {a3, 0, 0, 0, -kRange, kRange},
                                      {0, kPi / 2, d4, 0, -kRange, kRange},
                                      {0, -kPi / 2, d5, 0, -kRange, kRange},
                                      {0, 0, d6, 0, -kRange, kRange}}};
  return arm_from_dh(name, rows);
}

Arm iiwa14() {
  const std::array<DhRow, 7> rows = {{{0, -kPi / 2, 0.36, 0, -2.97, 2.97},
                                      {0, kPi / 2, 0, 0, -2.09, 2.09},
                                      {0, kPi / 2, 0.42, 0, -2.97, 2.97},
                                      {0, -kPi / 2, 0, 0, -2.09, 2.09},
                                      {0, -kPi / 2, 0.4, 0, -2.97, 2.97},
                                      {0, kPi / 2, 0, 0, -2.09, 2.09},
                                      {0, 0, 0.126, 0, -3.05, 3.05}}};
  return arm_from_dh("iiwa14", rows);
}

// A curved wrist of two bends of 60 degrees, joints 1, 4, 5 and 6 without limits.
Arm curved_wrist() {
  constexpr JointKind kFree = JointKind::continuous;
  const double bend = kPi / 3;
  const double e2 = 0.0098;
  const double aa = kPi / 6;
  const double d4b = 0.2073 + std::sin(aa) / std::sin(2 * aa) * 0.0743;
  const double d5b = 2 * std::sin(aa) / std::sin(2 * aa) * 0.0743;
  const double d6b = std::sin(aa) / std::sin(2 * aa) * 0.0743 + 0.1687;
  const std::array<DhRow, 6> rows = {{{0, kPi / 2, 0.2755, 0, 0, 0, kFree},
                                      {0.41, kPi, 0, 0, 0.82, 5.46},
                                      {0, kPi / 2, -e2, 0, 0.33, 5.95},
                                      {0, bend, -d4b, 0, 0, 0, kFree},
                                      {0, bend, -d5b, 0, 0, 0, kFree},
                                      {0, kPi, -d6b, 0, 0, 0, kFree}}};
  return arm_from_dh("curved-wrist-6", rows);
}

Arm puma560() {
  const std::array<DhRow, 6> rows = {{{0, kPi / 2, 0.67, 0, -2.79, 2.79},
                                      {0.4318, 0, 0, 0, -0.7854, 3.927},
                                      {0.0203, -kPi / 2, 0.15, 0, -3.927, 0.7854},
                                      {0, kPi / 2, 0.4318, 0, -1.92, 2.967},
                                      {0, -kPi / 2, 0, 0, -1.745, 1.745},
                                      {0, 0, 0.0563, 0, -4.64, 4.64}}};
  return arm_from_dh("puma560", rows);
}

// Offsets at shoulder, elbow and wrist; seven joints.
Arm offset_seven() {
  const std::array<DhRow, 7> rows = {{{0.069, -kPi / 2, 0.27, 0, -1.70, 1.70},
                                      {0, kPi / 2, 0, kPi / 2, -2.147, 1.047},
                                      {0.069, -kPi / 2, 0.364, 0, -3.054, 3.054},
                                      {0, kPi / 2, 0, 0, -0.05, 2.618},
                                      {0.010, -kPi / 2, 0.374, 0, -3.059, 3.059},
                                      {0, kPi / 2, 0, 0, -1.57, 2.094},
                                      {0, 0, 0.28, 0, -3.059, 3.059}}};
  return arm_from_dh("offset-7", rows);
}

Arm five_joints() {
  const std::array<DhRow, 5> rows = {{{0.1, kPi / 2, 0.4, 0, -2.9, 2.9},
                                      {0.5, 0, 0, 0, -1.2, 2.3},
                                      {0.6, 0, 0, 0, -2.4, 2.4},
                                      {0.05, kPi / 2, 0, 0, -2.0, 2.0},
                                      {0, 0, 0.12, 0, -4.0, 4.0}}};
  return arm_from_dh("five-5", rows);
}

Arm scara() {
  const std::array<DhRow, 4> rows = {{{0.35, 0, 0.3, 0, -2.2, 2.2},
                                      {0.25, kPi, 0, 0, -2.5, 2.5},
                                      {0, 0, 0, 0, 0.0, 0.2, JointKind::prismatic},
                                      {0, 0, 0.05, 0, -6.2, 6.2}}};
  return arm_from_dh("scara-4", rows);
}

// On a rail of two metres.
Arm rail_seven() {
  const std::array<DhRow, 7> rows = {{{0, -kPi / 2, 0, 0, 0.0, 2.0, JointKind::prismatic},
                                      {0.15, kPi / 2, 0.3, 0, -2.9, 2.9},
                                      {0.5, 0, 0, 0, -1.0, 2.6},
                                      {0.1, kPi / 2, 0, 0, -2.6, 1.6},
                                      {0, -kPi / 2, 0.6, 0, -3.1, 3.1},
                                      {0, kPi / 2, 0, 0, -2.0, 2.0},
                                      {0, 0, 0.1, 0, -6.1, 6.1}}};
  return arm_from_dh("rail-7", rows);
}

}  // namespace

std::vector<Arm> shared_arms() {
  std::vector<Arm> arms;
  for (const SharedArm& arm : cellmirror::shared_arms()) {
    arms.push_back({arm.id, chain_of_urdf(arm.urdf, arm.base, arm.tip)});
  }
  return arms;
}

Arm random_arm(std::size_t joints, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random);
  };
  std::vector<DhRow> rows;
  for (std::size_t i = 0; i < joints; ++i) {
    DhRow row;
    row.a = uniform(-0.4, 0.4);
    row.d = uniform(-0.4, 0.4);
    row.alpha = uniform(0, 1) < 0.7 ? kPi / 2 * std::round(uniform(-2, 2)) : uniform(-kPi, kPi);
    row.theta = uniform(-kPi, kPi);
    const double kind = uniform(0, 1);
    if (kind < 0.12 && i + 1 < joints) {
      row.kind = JointKind::prismatic;
      row.lower = uniform(-0.3, 0.0);
      row.upper = row.lower + uniform(0.2, 0.6);
    } else if (kind < 0.25) {
      row.kind = JointKind::continuous;
    } else {
      const double width = kind < 0.4 ? uniform(0.3, 1.0) : uniform(2.0, 2 * kPi);  // some are narrow
      row.lower = uniform(-kPi, kPi - 0.5 * width);
      row.upper = row.lower + width;
    }
    rows.push_back(row);
  }
  return arm_from_dh("random-" + std::to_string(joints) + "-" + std::to_string(seed), rows);
}

std::vector<Arm> unseen_arms() {
  std::vector<Arm> arms;
  arms.push_back(universal("ur3", 0.1519, -0.24365, -0.21325, 0.11235, 0.08535, 0.0819));
  arms.push_back(universal("ur10", 0.1273, -0.612, -0.5723, 0.163941, 0.1157, 0.0922));
  arms.push_back(puma560());
  arms.push_back(curved_wrist());
  arms.push_back(iiwa14());
  arms.push_back(offset_seven());
  arms.push_back(rail_seven());
  arms.push_back(five_joints());
  arms.push_back(scara());
  for (std::uint64_t seed = 1; seed <= 4; ++seed) arms.push_back(random_arm(6, seed));
  for (std::uint64_t seed = 1; seed <= 3; ++seed) arms.push_back(random_arm(7, seed));
  arms.push_back(random_arm(5, 1));
  arms.push_back(random_arm(4, 1));
  arms.push_back(random_arm(8, 1));
  arms.push_back(random_arm(8, 2));
  return arms;
}

std::vector<JointValues> random_postures(const Chain& chain, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<JointValues> postures(count);
  for (JointValues& q : postures) q = random_posture(chain, random);
  return postures;
}

}  // namespace cellmirror::test_arms
