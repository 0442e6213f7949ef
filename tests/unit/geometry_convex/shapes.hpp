// Shapes for tests of convex queries, and what proves an answer: points that lie on the bodies bound the distance from
// above, the plane between them bounds it from below. Shares no code with what it proves.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "rt_core/geometry/convex.hpp"

namespace cellmirror::geometry {

inline ConvexCore sphere(double radius) { return {CoreKind::point, Eigen::Vector3d::Zero(), {}, radius}; }
inline ConvexCore capsule(double radius, double half_length) {
  return {CoreKind::segment, {0, 0, half_length}, {}, radius};
}
inline ConvexCore box(double x, double y, double z) { return {CoreKind::box, {x, y, z}, {}, 0.0}; }
inline ConvexCore cylinder(double radius, double half_length) {
  return {CoreKind::cylinder, {radius, radius, half_length}, {}, 0.0};
}
inline ConvexCore triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return {CoreKind::triangle, Eigen::Vector3d::Zero(), {a, b, c}, 0.0};
}

inline Pose at(double x, double y, double z) {
  Pose X = Pose::Identity();
  X.translation() = Eigen::Vector3d(x, y, z);
  return X;
}
inline Pose turned(const Pose& X, double angle, const Eigen::Vector3d& axis) {
  return X * Eigen::AngleAxisd(angle, axis.normalized());
}

// How far a shape reaches along the unit vector n, from the origin of W.
inline double reach(const ConvexCore& core, const Pose& X, const Eigen::Vector3d& n) {
  const Eigen::Vector3d own = X.linear().transpose() * n;
  double most = 0.0;
  switch (core.kind) {
    case CoreKind::point:
      break;
    case CoreKind::segment:
      most = core.half.z() * std::abs(own.z());
      break;
    case CoreKind::box:
      most = core.half.dot(own.cwiseAbs());
      break;
    case CoreKind::cylinder:
      most = core.half.x() * std::hypot(own.x(), own.y()) + core.half.z() * std::abs(own.z());
      break;
    case CoreKind::triangle:
      most = std::max({own.dot(core.corners[0]), own.dot(core.corners[1]), own.dot(core.corners[2])});
  }
  return most + core.skin + n.dot(X.translation());
}

// How far a point lies outside of a shape (not of triangles, of which it lies outside the plane and the edges).
inline double outside(const ConvexCore& core, const Pose& X, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p = X.linear().transpose() * (p_W - X.translation());
  double off = 0.0;
  switch (core.kind) {
    case CoreKind::point:
      off = p.norm();
      break;
    case CoreKind::segment:
      off = (p - Eigen::Vector3d(0, 0, std::clamp(p.z(), -core.half.z(), core.half.z()))).norm();
      break;
    case CoreKind::box:
      off = (p.cwiseAbs() - core.half).cwiseMax(0.0).norm();
      break;
    case CoreKind::cylinder:
      off = std::hypot(std::max(0.0, std::hypot(p.x(), p.y()) - core.half.x()),
                       std::max(0.0, std::abs(p.z()) - core.half.z()));
      break;
    case CoreKind::triangle: {
      const Eigen::Vector3d normal =
          (core.corners[1] - core.corners[0]).cross(core.corners[2] - core.corners[0]).normalized();
      off = std::abs(normal.dot(p - core.corners[0]));
      for (std::size_t i = 0; i < 3; ++i) {
        const Eigen::Vector3d edge = (core.corners[(i + 1) % 3] - core.corners[i]).normalized();
        off = std::max(off, -normal.cross(edge).dot(p - core.corners[i]));
      }
    }
  }
  return std::max(0.0, off - core.skin);
}

// Proves the answer to `tolerance`. A distance of 0 is proved by the common point.
inline ::testing::AssertionResult proved(const ConvexCore& a, const Pose& X_WA, const ConvexCore& b, const Pose& X_WB,
                                         const ConvexDistance& answer, double tolerance) {
  const ClosestPoints& points = answer.points;
  if (!answer.certain) return ::testing::AssertionFailure() << "is not certain";
  if (outside(a, X_WA, points.p_a) > tolerance) {
    return ::testing::AssertionFailure() << "p_a is off by " << outside(a, X_WA, points.p_a);
  }
  if (outside(b, X_WB, points.p_b) > tolerance) {
    return ::testing::AssertionFailure() << "p_b is off by " << outside(b, X_WB, points.p_b);
  }
  const Eigen::Vector3d gap = points.p_b - points.p_a;
  if (std::abs(gap.norm() - points.distance) > tolerance) {
    return ::testing::AssertionFailure() << "points are " << gap.norm() << " apart, not " << points.distance;
  }
  if (points.distance <= tolerance) return ::testing::AssertionSuccess();
  // Seen from p_a, so that no digits are lost far from the origin.
  Pose X_PA = X_WA;
  Pose X_PB = X_WB;
  X_PA.translation() -= points.p_a;
  X_PB.translation() -= points.p_a;
  Eigen::Vector3d n = gap.normalized();
  const auto height = [&](const Eigen::Vector3d& m) { return -reach(b, X_PB, -m) - reach(a, X_PA, m); };
  double plane = height(n);
  // Any plane is a proof. Where points are right to 1e-8 m, whose distance then is right to 1e-16, that between them is
  // not yet the best one.
  for (double step = 1e-6; step > 1e-11 && plane < points.distance - tolerance; step *= 0.7) {
    const Eigen::Vector3d x = n.unitOrthogonal();
    for (const Eigen::Vector3d& aside : {x, Eigen::Vector3d(n.cross(x))}) {
      for (const double way : {-step, step}) {
        const Eigen::Vector3d other = (n + way * aside).normalized();
        if (height(other) <= plane) continue;
        n = other;
        plane = height(other);
      }
    }
  }
  if (plane < points.distance - tolerance) {
    return ::testing::AssertionFailure() << points.distance << " but the plane between them shows only " << plane;
  }
  return ::testing::AssertionSuccess();
}

// Seeded, so that a failure can be met again.
class AnyShapes {
 public:
  explicit AnyShapes(std::uint64_t seed) : engine_(seed) {}

  double part() { return distribution_(engine_); }  // -1..1
  Eigen::Vector3d vector() { return {part(), part(), part()}; }
  Eigen::Vector3d direction() {
    Eigen::Vector3d v = vector();
    while (v.squaredNorm() > 1.0 || v.squaredNorm() < 1e-4) v = vector();
    return v.normalized();
  }
  Pose pose(double half) {
    Pose X = Pose::Identity();
    X.linear() = Eigen::AngleAxisd(std::numbers::pi * part(), direction()).toRotationMatrix();
    X.translation() = half * vector();
    return X;
  }
  // Axes along those of W, positions on a grid: faces that are flush, edges that are parallel.
  Pose flush_pose() {
    static const Eigen::AngleAxisd kTurns[] = {{0.0, Eigen::Vector3d::UnitX()},
                                               {std::numbers::pi / 2, Eigen::Vector3d::UnitX()},
                                               {std::numbers::pi / 2, Eigen::Vector3d::UnitY()},
                                               {std::numbers::pi / 4, Eigen::Vector3d::UnitZ()}};
    Pose X = Pose::Identity();
    X.linear() = kTurns[engine_() % 4].toRotationMatrix();
    X.translation() = (2.0 * vector()).array().round().matrix() * 0.25;
    return X;
  }
  double size() { return 0.02 + 0.5 * std::pow(std::abs(part()), 2); }
  ConvexCore core(CoreKind kind) {
    ConvexCore out;
    switch (kind) {
      case CoreKind::point:
        out = sphere(0.0);
        break;
      case CoreKind::segment:
        out = capsule(0.0, size());
        break;
      case CoreKind::box:
        out = box(size(), size(), size());
        break;
      case CoreKind::cylinder:
        out = cylinder(size(), size());
        break;
      case CoreKind::triangle:
        out = triangle(0.5 * vector(), 0.5 * vector(), 0.5 * vector());
    }
    if (engine_() % 2 == 0) out.skin = 0.2 * size();
    return out;
  }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> distribution_{-1.0, 1.0};
};

inline constexpr CoreKind kAllKinds[] = {CoreKind::point, CoreKind::segment, CoreKind::box, CoreKind::cylinder,
                                         CoreKind::triangle};

inline std::string name(CoreKind kind) {
  static const char* const kNames[] = {"point", "segment", "box", "cylinder", "triangle"};
  return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace cellmirror::geometry
