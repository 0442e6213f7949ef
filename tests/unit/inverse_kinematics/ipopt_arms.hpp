// Small arms for the tests of Ipopt's searches.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "rt_core/base/time.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::inverse_kinematics::ipopt_test {

inline const SystemClock kClock;  // for the time limits of searches

using kinematics::Chain;
using kinematics::ChainJoint;
using kinematics::Variable;

inline ChainJoint joint_at(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy, std::size_t variable,
                           JointKind kind = JointKind::revolute) {
  ChainJoint joint;
  joint.X_PJ = pose_from_xyz_rpy(xyz, rpy);
  joint.kind = kind;
  joint.variable = static_cast<std::uint8_t>(variable);
  return joint;
}

inline Variable turning(double lower, double upper) { return {"joint", JointKind::revolute, lower, upper}; }

// Links of `length` m in the plane z = 0, every joint about z.
inline Chain planar_arm(std::size_t joints, double length = 1.0, double limit = 3.0) {
  std::vector<ChainJoint> chain;
  for (std::size_t i = 0; i < joints; ++i) chain.push_back(joint_at({i == 0 ? 0.0 : length, 0, 0}, {0, 0, 0}, i));
  return Chain::make(std::vector<Variable>(joints, turning(-limit, limit)), chain,
                     pose_from_xyz_rpy({length, 0, 0}, {0, 0, 0}))
      .value();
}

// A seven-joint arm with bent and turned links, one sliding joint and one continuous one among them, and a mimic.
inline Chain odd_arm() {
  const double h = std::numbers::pi / 2;
  std::vector<ChainJoint> joints = {joint_at({0, 0, 0.3}, {0, 0, 0}, 0),
                                    joint_at({0.1, 0, 0.1}, {-h, 0.2, 0}, 1),
                                    joint_at({0.3, 0, 0.05}, {0, 0.3, 0.1}, 2),
                                    joint_at({0.2, 0.1, 0}, {h, 0, 0.4}, 3),
                                    joint_at({0, 0, 0.1}, {0, 0, 0}, 4, JointKind::prismatic),
                                    joint_at({0, 0.05, 0.1}, {-h, 0, 0}, 5),
                                    joint_at({0, 0, 0.05}, {h, 0.1, 0}, 6)};
  ChainJoint mimic = joint_at({0.05, 0, 0.1}, {0.3, 0.2, 0.1}, 2);
  mimic.multiplier = -0.5;
  mimic.offset = 0.1;
  joints.insert(joints.begin() + 5, mimic);
  std::vector<Variable> variables(7, turning(-2.5, 2.5));
  variables[4] = {"slide", JointKind::prismatic, -0.1, 0.3};
  variables[6].kind = JointKind::continuous;
  return Chain::make(variables, joints, pose_from_xyz_rpy({0, 0, 0.1}, {0.1, 0, 0})).value();
}

// A six-joint arm with a spherical wrist.
inline Chain wrist_arm() {
  const double h = std::numbers::pi / 2;
  const std::vector<ChainJoint> joints = {joint_at({0, 0, 0.4}, {0, 0, 0}, 0), joint_at({0.1, 0, 0}, {-h, 0, 0}, 1),
                                          joint_at({0.4, 0, 0}, {0, 0, 0}, 2), joint_at({0.05, 0.35, 0}, {-h, 0, 0}, 3),
                                          joint_at({0, 0, 0}, {h, 0, 0}, 4),   joint_at({0, 0, 0}, {-h, 0, 0}, 5)};
  return Chain::make(std::vector<Variable>(6, turning(-2.6, 2.6)), joints, pose_from_xyz_rpy({0, 0, 0.1}, {0, 0, 0}))
      .value();
}

inline JointValues random_posture(const Chain& chain, std::mt19937_64& random, double share = 1.0) {
  JointValues q{};
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    const bool bounded = std::isfinite(chain.lower()[i]);
    const double half = bounded ? 0.5 * (chain.upper()[i] - chain.lower()[i]) : std::numbers::pi;
    q[i] = chain.middle()[i] + share * half * std::uniform_real_distribution<double>(-1.0, 1.0)(random);
  }
  return q;
}

inline Pose pose_at(const Chain& chain, const JointValues& q) {
  return kinematics::forward(chain, {q.data(), chain.variable_count()});
}

}  // namespace cellmirror::inverse_kinematics::ipopt_test
