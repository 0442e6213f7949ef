// Mechanisms for tests.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <vector>

#include "rt_core/dynamics/mechanism.hpp"
#include "rt_core/kinematics/joint_motion.hpp"

namespace cellmirror::dynamics {

inline Inertia point_mass(double mass, const Eigen::Vector3d& p) { return {mass, p, Eigen::Matrix3d::Zero()}; }

// One drive a variable; where none are given, as many as links without any of their own.
inline Mechanism made(const std::vector<Link>& links, int tip = -1, std::vector<Drive> drives = {},
                      const Pose& X_LT = Pose::Identity()) {
  if (drives.empty()) drives.resize(links.size());
  auto mechanism = Mechanism::make(drives, links, tip, X_LT);
  if (!mechanism) throw std::runtime_error(mechanism.error().text());
  return *mechanism;
}

// A branched mechanism of turning and sliding joints, every joint a variable, the tip on the last link; and its energy,
// computed from poses and velocities of all centres of mass in the world.
struct RandomMechanism {
  static constexpr std::size_t kLinks = 7;

  explicit RandomMechanism(std::mt19937_64& random) : mechanism(make(random)) {}

  static double value(std::mt19937_64& random) { return std::uniform_real_distribution<double>(-1.5, 1.5)(random); }
  static Eigen::Vector3d vector(std::mt19937_64& random) {
    const double x = value(random);
    const double y = value(random);
    return {x, y, value(random)};
  }
  static Pose pose(std::mt19937_64& random) {
    Pose X = Pose::Identity();
    X.linear() = Eigen::AngleAxisd(value(random), vector(random).normalized()).toRotationMatrix();
    X.translation() = vector(random);
    return X;
  }
  static Mechanism make(std::mt19937_64& random) {
    std::vector<Link> links(kLinks);
    for (std::size_t i = 0; i < kLinks; ++i) {
      const bool branch = i > 0 && random() % 3 == 0;
      links[i].parent = static_cast<int>(branch ? random() % i : i - 1);
      if (i == 0) links[i].parent = -1;
      links[i].variable = static_cast<std::uint8_t>(i);
      links[i].kind = random() % 3 == 0 ? JointKind::prismatic : JointKind::revolute;
      links[i].axis = vector(random).normalized();
      links[i].X_PJ = pose(random);
      const Eigen::Matrix3d root = Eigen::Matrix3d::NullaryExpr([&] { return value(random); });
      links[i].inertia = {2.0 + value(random), vector(random), root * root.transpose()};
    }
    return made(links, kLinks - 1, {}, pose(random));
  }
  std::vector<double> values(std::mt19937_64& random) const {
    std::vector<double> all(variables);
    for (double& one : all) one = value(random);
    return all;
  }

  [[nodiscard]] Pose X_WL(int link, const std::vector<double>& q) const {
    if (link < 0) return Pose::Identity();
    const Link& at = mechanism.links()[static_cast<std::size_t>(link)];
    Pose X = X_WL(at.parent, q) * at.X_PJ;
    kinematics::apply_joint(at.kind, at.axis, q[at.variable], X);
    return X;
  }

  // Velocities by small differences of poses.
  [[nodiscard]] double energy(const std::vector<double>& q, const std::vector<double>& qd) const {
    constexpr double kStep = 1e-6;
    std::vector<double> before = q;
    std::vector<double> after = q;
    for (std::size_t i = 0; i < variables; ++i) {
      before[i] -= kStep * qd[i];
      after[i] += kStep * qd[i];
    }
    double energy = 0;
    for (int i = 0; i < static_cast<int>(kLinks); ++i) {
      const Inertia& body = mechanism.links()[static_cast<std::size_t>(i)].inertia;
      const Pose X = X_WL(i, q);
      const Pose earlier = X_WL(i, before);
      const Pose later = X_WL(i, after);
      const Eigen::Vector3d v = (later * body.p_C - earlier * body.p_C) / (2 * kStep);
      const Eigen::Matrix3d W = (later.linear() - earlier.linear()) / (2 * kStep) * X.linear().transpose();
      const Eigen::Vector3d w(W(2, 1), W(0, 2), W(1, 0));
      const Eigen::Vector3d w_L = X.linear().transpose() * w;
      energy += 0.5 * body.mass * v.squaredNorm() + 0.5 * w_L.dot(body.I_C * w_L);
      energy += body.mass * 9.80665 * (X * body.p_C).z();
    }
    return energy;
  }

  Mechanism mechanism;
  std::size_t variables = kLinks;
};

}  // namespace cellmirror::dynamics
