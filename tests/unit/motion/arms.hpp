// Arms of known geometry for the tests and the benchmark of motion.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "rt_core/kinematics/chain.hpp"

namespace cellmirror::motion::test_arms {

struct DhRow {
  double alpha;  // rad
  double a;      // m
  double d;      // m
  double lower;  // rad
  double upper;
};

// Modified Denavit-Hartenberg parameters (Craig): the frame of a joint is Rx(alpha) Tx(a) Tz(d) of the one before.
inline kinematics::Chain arm_of(std::span<const DhRow> rows, double tool) {
  std::vector<kinematics::Variable> variables;
  std::vector<kinematics::ChainJoint> joints;
  for (const DhRow& row : rows) {
    kinematics::ChainJoint joint;
    joint.X_PJ = Eigen::AngleAxisd(row.alpha, Eigen::Vector3d::UnitX()) * Eigen::Translation3d(row.a, 0, row.d);
    joint.variable = static_cast<std::uint8_t>(joints.size());
    joints.push_back(joint);
    variables.push_back({"j" + std::to_string(joints.size()), JointKind::revolute, row.lower, row.upper});
  }
  Pose X_LT = Pose::Identity();
  X_LT.translation().z() = tool;
  return kinematics::Chain::make(variables, joints, X_LT).value();
}

inline constexpr double kHalfPi = std::numbers::pi / 2;

// PUMA 560, after Corke's parameters, with a tool of 100 mm.
inline kinematics::Chain puma() {
  constexpr std::array<DhRow, 6> kRows = {{{0, 0, 0, -2.79, 2.79},
                                           {-kHalfPi, 0, 0.2435, -3.93, 0.78},
                                           {0, 0.4318, -0.0934, -0.78, 3.93},
                                           {-kHalfPi, 0.0203, 0.4331, -1.92, 2.96},
                                           {kHalfPi, 0, 0, -1.74, 1.74},
                                           {-kHalfPi, 0, 0, -4.64, 4.64}}};
  return arm_of(kRows, 0.1);
}
inline JointValues puma_posture() { return {0.2, -0.9, 0.6, 0.3, 0.9, -0.4}; }

// Franka Emika Panda: seven joints.
inline kinematics::Chain panda() {
  constexpr std::array<DhRow, 7> kRows = {{{0, 0, 0.333, -2.89, 2.89},
                                           {-kHalfPi, 0, 0, -1.76, 1.76},
                                           {kHalfPi, 0, 0.316, -2.89, 2.89},
                                           {kHalfPi, 0.0825, 0, -3.07, -0.07},
                                           {-kHalfPi, -0.0825, 0.384, -2.89, 2.89},
                                           {kHalfPi, 0, 0, -0.01, 3.75},
                                           {kHalfPi, 0.088, 0, -2.89, 2.89}}};
  return arm_of(kRows, 0.107);
}
inline JointValues panda_posture() { return {0.1, -0.5, 0.2, -2.1, 0.1, 1.7, 0.6}; }

// Three sliding axes.
inline kinematics::Chain gantry() {
  std::vector<kinematics::Variable> variables;
  std::vector<kinematics::ChainJoint> joints(3);
  // Quarter turns that bring z to x and y. (FromTwoVectors() takes five seconds to compile.)
  const std::array<Eigen::Quaterniond, 3> turn = {
      Eigen::Quaterniond(Eigen::AngleAxisd(kHalfPi, Eigen::Vector3d::UnitY())),
      Eigen::Quaterniond(Eigen::AngleAxisd(-kHalfPi, Eigen::Vector3d::UnitX())), Eigen::Quaterniond::Identity()};
  Eigen::Quaterniond R = Eigen::Quaterniond::Identity();
  for (std::size_t i = 0; i < 3; ++i) {
    joints[i].kind = JointKind::prismatic;
    joints[i].variable = static_cast<std::uint8_t>(i);
    joints[i].X_PJ.linear() = (R.conjugate() * turn[i]).toRotationMatrix();
    R = turn[i];
    variables.push_back({std::string(1, "xyz"[i]), JointKind::prismatic, -2.0, 2.0});
  }
  return kinematics::Chain::make(variables, joints, Pose::Identity()).value();
}

}  // namespace cellmirror::motion::test_arms
