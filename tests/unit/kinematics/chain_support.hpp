// What several tests of kinematics share: chains by the textbook, and forward kinematics as a plain product of poses.
#pragma once

#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "rt_core/kinematics/chain.hpp"
#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::kinematics {

inline constexpr double kDeg = std::numbers::pi / 180;

inline Pose translation(double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); }
inline Pose turn(double angle, const Eigen::Vector3d& axis) { return Pose(Eigen::AngleAxisd(angle, axis)); }

inline double difference(const Pose& a, const Pose& b) { return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff(); }

// A row of a table of Denavit and Hartenberg in its standard form: Rz(theta) Tz(d) Tx(a) Rx(alpha); m, rad.
struct DhRow {
  double a = 0;
  double alpha = 0;
  double d = 0;
  double theta_zero = 0;
};

inline Chain chain_of(std::vector<ChainJoint> joints, std::size_t variables, const Pose& X_LT) {
  std::vector<Variable> list;
  for (std::size_t i = 0; i < variables; ++i) list.push_back({"q" + std::to_string(i + 1), JointKind::revolute, -3, 3});
  auto chain = Chain::make(std::move(list), joints, X_LT);
  if (!chain) throw std::runtime_error(chain.error().text());
  return std::move(*chain);
}

inline Chain chain_of_table(std::span<const DhRow> rows) {
  std::vector<ChainJoint> joints;
  Pose X = Pose::Identity();
  for (const DhRow& row : rows) {
    ChainJoint joint;
    joint.X_PJ = X * turn(row.theta_zero, Eigen::Vector3d::UnitZ());
    joint.variable = static_cast<std::uint8_t>(joints.size());
    joints.push_back(joint);
    X = translation(0, 0, row.d) * translation(row.a, 0, 0) * turn(row.alpha, Eigen::Vector3d::UnitX());
  }
  return chain_of(std::move(joints), rows.size(), X);
}

inline Pose plain_product(const Chain& chain, std::span<const double> q) {
  Pose X = Pose::Identity();
  for (const ChainJoint& joint : chain.joints()) {
    const double value = joint.multiplier * q[joint.variable] + joint.offset;
    X = X * joint.X_PJ;
    if (joint.kind == JointKind::prismatic) {
      X = X * translation(0, 0, value);
    } else {
      X = X * turn(value, Eigen::Vector3d::UnitZ());
    }
  }
  return X * chain.X_LT();
}

// The Jacobian by central differences of the plain product; its error is near 1e-9.
inline Eigen::MatrixXd jacobian_by_differences(const Chain& chain, std::span<const double> q) {
  constexpr double kStep = 1e-5;
  Eigen::MatrixXd jacobian(6, chain.variable_count());
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    std::vector<double> moved(q.begin(), q.end());
    moved[i] = q[i] + kStep;
    const Pose after = plain_product(chain, moved);
    moved[i] = q[i] - kStep;
    const Pose before = plain_product(chain, moved);
    jacobian.col(static_cast<Eigen::Index>(i)) = pose_error(before, after) / (2 * kStep);
  }
  return jacobian;
}

inline Pose random_pose(std::mt19937_64& random) {
  std::uniform_real_distribution<double> part(-1, 1);
  Pose X(Eigen::Quaterniond(part(random), part(random), part(random), part(random)).normalized());
  X.translation() = Eigen::Vector3d(part(random), part(random), part(random));
  return X;
}

// Any kinds and poses; every third joint follows an earlier variable as a mimic, unless all are to be `plain`.
inline Chain random_chain(std::size_t joint_count, bool plain, std::mt19937_64& random) {
  std::uniform_real_distribution<double> part(-1, 1);
  std::vector<ChainJoint> joints;
  std::vector<Variable> variables;
  for (std::size_t i = 0; i < joint_count; ++i) {
    ChainJoint joint;
    joint.X_PJ = random_pose(random);
    joint.kind = part(random) < -0.3 ? JointKind::prismatic : JointKind::revolute;
    const bool mimic = !plain && (i % 3 == 2 || variables.size() == kMaxVariables);
    if (mimic) {
      joint.variable = static_cast<std::uint8_t>(i * 7 % variables.size());
      joint.multiplier = 2 * part(random);
      joint.offset = part(random);
    } else {
      joint.variable = static_cast<std::uint8_t>(variables.size());
      variables.push_back({"q" + std::to_string(i + 1), joint.kind, -2.0, 2.0});
    }
    joints.push_back(joint);
  }
  auto chain = Chain::make(std::move(variables), joints, random_pose(random));
  if (!chain) throw std::runtime_error(chain.error().text());
  return std::move(*chain);
}

inline std::vector<double> random_values(std::size_t count, double largest, std::mt19937_64& random) {
  std::uniform_real_distribution<double> part(-largest, largest);
  std::vector<double> q(count);
  for (double& value : q) value = part(random);
  return q;
}

}  // namespace cellmirror::kinematics
