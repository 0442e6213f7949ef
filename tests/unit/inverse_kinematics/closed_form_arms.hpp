// Arms for the tests of the closed forms: from lines in space, from DH tables, and random ones of each family.
#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/kinematics/chain.hpp"

namespace cellmirror::inverse_kinematics::test {

using Vector = Eigen::Vector3d;

struct Axis {
  Vector h = Vector::UnitZ();
  Vector o = Vector::Zero();
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  double angle() { return between(-std::numbers::pi, std::numbers::pi); }
  Vector vector(double size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
  Vector direction() {
    std::normal_distribution<double> draw;
    return Vector(draw(engine_), draw(engine_), draw(engine_)).normalized();
  }
  // Makes at least 0.3 rad with `other`.
  Vector direction_across(const Vector& other) {
    Vector h = direction();
    while (h.cross(other).norm() < 0.3) h = direction();
    return h;
  }
  Eigen::Matrix3d rotation() { return Eigen::AngleAxisd(angle(), direction()).toRotationMatrix(); }
  JointValues posture() {
    JointValues q{};
    for (double& value : std::span(q).first(7)) value = angle();
    return q;
  }

 private:
  std::mt19937_64 engine_;
};

inline kinematics::Chain chain_of_frames(std::span<const Pose> X_PJ, const Pose& X_LT) {
  std::vector<kinematics::Variable> variables;
  std::vector<kinematics::ChainJoint> joints;
  for (std::size_t i = 0; i < X_PJ.size(); ++i) {
    variables.push_back({fmt::format("joint_{}", i + 1), JointKind::revolute, -std::numbers::pi, std::numbers::pi});
    kinematics::ChainJoint joint;
    joint.X_PJ = X_PJ[i];
    joint.variable = static_cast<std::uint8_t>(i);
    joints.push_back(joint);
  }
  return kinematics::Chain::make(std::move(variables), joints, X_LT).value();
}

// Frames anywhere on the axes and turned about them at random; a random tip.
inline kinematics::Chain chain_of_axes(std::span<const Axis> axes, Random& random) {
  std::vector<Pose> X_PJ;
  Pose X_BP = Pose::Identity();
  for (const Axis& axis : axes) {
    Pose X_BJ = Pose::Identity();
    X_BJ.linear().col(2) = axis.h;
    X_BJ.linear().col(0) = axis.h.cross(random.direction_across(axis.h)).normalized();
    X_BJ.linear().col(1) = axis.h.cross(X_BJ.linear().col(0));
    X_BJ.translation() = axis.o + random.between(-0.2, 0.2) * axis.h;
    X_PJ.push_back(X_BP.inverse() * X_BJ);
    X_BP = X_BJ;
  }
  Pose X_LT = Pose::Identity();
  X_LT.linear() = random.rotation();
  X_LT.translation() = random.vector(0.2);
  return chain_of_frames(X_PJ, X_LT);
}

struct DhRow {
  double a, alpha, d, theta;  // m, rad, m, rad (offset of the joint)
};

// Standard convention: Rz(theta + q) Tz(d) Tx(a) Rx(alpha).
inline kinematics::Chain chain_of_dh(std::span<const DhRow> rows) {
  std::vector<Pose> X_PJ;
  Pose X_LP = Pose::Identity();  // what follows the joint before
  for (const DhRow& row : rows) {
    X_PJ.push_back(X_LP * Pose(Eigen::AngleAxisd(row.theta, Vector::UnitZ())));
    X_LP = Pose(Eigen::Translation3d(0, 0, row.d)) * Pose(Eigen::Translation3d(row.a, 0, 0)) *
           Pose(Eigen::AngleAxisd(row.alpha, Vector::UnitX()));
  }
  return chain_of_frames(X_PJ, X_LP);
}

inline constexpr double kQuarter = std::numbers::pi / 2;

// Corke and Armstrong-Helouvry, "A search for consensus among model parameters reported for the PUMA 560", 1994.
inline kinematics::Chain puma_560() {
  return chain_of_dh(std::vector<DhRow>{{0, kQuarter, 0.672, 0},
                                        {0.4318, 0, 0, 0},
                                        {0.0203, -kQuarter, 0.15005, 0},
                                        {0, kQuarter, 0.4318, 0},
                                        {0, -kQuarter, 0, 0},
                                        {0, 0, 0, 0}});
}

// Geometry of the DLR measurements (Otter and Tuerk, 1988); zero is straight up.
inline kinematics::Chain manutec_r3() {
  return chain_of_dh(std::vector<DhRow>{{0, kQuarter, 0, 0},
                                        {0.5, 0, 0, kQuarter},
                                        {0, kQuarter, 0, kQuarter},
                                        {0, -kQuarter, 0.73, 0},
                                        {0, kQuarter, 0, 0},
                                        {0, 0, 0.25, 0}});
}

// Universal Robots' published table of the UR5.
inline kinematics::Chain ur_5() {
  return chain_of_dh(std::vector<DhRow>{{0, kQuarter, 0.089159, 0},
                                        {-0.425, 0, 0, 0},
                                        {-0.39225, 0, 0, 0},
                                        {0, kQuarter, 0.10915, 0},
                                        {0, -kQuarter, 0.09465, 0},
                                        {0, 0, 0.0823, 0}});
}

// Shape of the first three axes of a random arm with a spherical wrist.
enum class Shoulder { parallel_23, intersecting_12, parallel_12, intersecting_23, general };

inline std::vector<Axis> wrist_arm(Shoulder shoulder, Random& random) {
  std::vector<Axis> axes(6);
  axes[0] = {random.direction(), random.vector(0.5)};
  axes[1] = {random.direction_across(axes[0].h), random.vector(0.5)};
  axes[2] = {random.direction_across(axes[1].h), random.vector(0.5)};
  if (shoulder == Shoulder::parallel_23) axes[2].h = random.between(-1, 1) < 0 ? axes[1].h : Vector(-axes[1].h);
  if (shoulder == Shoulder::parallel_12) axes[0].h = random.between(-1, 1) < 0 ? axes[1].h : Vector(-axes[1].h);
  if (shoulder == Shoulder::intersecting_12) axes[0].o = axes[1].o;
  if (shoulder == Shoulder::intersecting_23) axes[2].o = axes[1].o;
  const Vector wrist = random.vector(1.0);
  for (std::size_t i = 3; i < 6; ++i) axes[i] = {random.direction_across(axes[i - 1].h), wrist};
  return axes;
}

inline std::vector<Axis> parallel_arm(bool intersecting_56, Random& random) {
  std::vector<Axis> axes(6);
  axes[1] = {random.direction(), random.vector(0.5)};
  axes[0] = {random.direction_across(axes[1].h), random.vector(0.5)};
  for (const std::size_t i : {2, 3}) axes[i] = {random.between(-1, 1) < 0 ? axes[1].h : -axes[1].h, random.vector(0.5)};
  axes[4] = {random.direction_across(axes[3].h), random.vector(0.5)};
  axes[5] = {random.direction_across(axes[4].h), intersecting_56 ? axes[4].o : random.vector(0.5)};
  return axes;
}

inline std::vector<Axis> from_tip_to_base(std::vector<Axis> axes) {
  std::ranges::reverse(axes);
  return axes;
}

}  // namespace cellmirror::inverse_kinematics::test
