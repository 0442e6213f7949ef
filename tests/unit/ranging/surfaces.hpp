// Surfaces of solids for tests of ranging, written anew and apart from the code that is tested.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/solid.hpp"

namespace cellmirror {

using Eigen::Vector3d;

inline geometry::Solid mesh_of(const std::vector<geometry::Triangle>& triangles) {
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  for (const geometry::Triangle& t : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
    mesh->vertices.insert(mesh->vertices.end(), t.begin(), t.end());
    mesh->triangles.push_back({first, first + 1, first + 2});
  }
  return geometry::make_mesh_solid(std::move(mesh));
}

inline double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline Vector3d in_cube(std::mt19937_64& random, double half) {
  return {uniform(random, -half, half), uniform(random, -half, half), uniform(random, -half, half)};
}

inline Pose random_pose(std::mt19937_64& random, double half) {
  return pose_from_xyz_rpy(in_cube(random, half), in_cube(random, std::numbers::pi));
}

struct SurfacePoint {
  Vector3d p = Vector3d::Zero();
  Vector3d normal = Vector3d::Zero();  // unit vector, either way
};

// The nearest point of a triangle's plane, moved into the triangle: a point of it, if not always the nearest.
inline SurfacePoint onto_triangle(const Vector3d& p, const geometry::Triangle& t) {
  const Vector3d u = t[1] - t[0];
  const Vector3d v = t[2] - t[0];
  const Vector3d normal = u.cross(v).normalized();
  Eigen::Matrix2d gram;
  gram << u.dot(u), u.dot(v), u.dot(v), v.dot(v);
  Eigen::Vector2d w = gram.inverse() * Eigen::Vector2d((p - t[0]).dot(u), (p - t[0]).dot(v));
  w = w.cwiseMax(0.0);
  if (w.sum() > 1.0) w /= w.sum();
  return {t[0] + w[0] * u + w[1] * v, normal};
}

inline SurfacePoint onto_box(const Vector3d& p, const Vector3d& half) {
  Vector3d q = p.cwiseMin(half).cwiseMax(-half);
  int axis = 0;
  (half - q.cwiseAbs()).minCoeff(&axis);
  q[axis] = std::copysign(half[axis], q[axis]);
  return {q, Vector3d::Unit(axis)};
}

inline SurfacePoint onto_cylinder(const Vector3d& p, double radius, double half_length) {
  const double across = std::hypot(p.x(), p.y());
  const Vector3d radial = across > 0.0 ? Vector3d(p.x() / across, p.y() / across, 0.0) : Vector3d::UnitX();
  const double z = std::clamp(p.z(), -half_length, half_length);
  if (half_length - std::abs(z) < std::abs(radius - across)) {
    return {std::min(across, radius) * radial + Vector3d(0, 0, std::copysign(half_length, z)), Vector3d::UnitZ()};
  }
  return {radius * radial + Vector3d(0, 0, z), radial};
}

inline SurfacePoint onto_round(const Vector3d& p, double radius, double half_length) {
  const Vector3d core(0, 0, std::clamp(p.z(), -half_length, half_length));
  const Vector3d out = p - core;
  const Vector3d normal = out.norm() > 0.0 ? Vector3d(out.normalized()) : Vector3d::UnitX();
  return {core + radius * normal, normal};
}

// A point of the primitive's surface near p; p and the answer in the solid's frame.
inline SurfacePoint onto_surface(const geometry::Solid& solid, const Vector3d& p) {
  const Vector3d& size = solid.size;
  switch (solid.shape) {
    case Shape::box:
      return onto_box(p, 0.5 * size);
    case Shape::cylinder:
      return onto_cylinder(p, size.x(), 0.5 * size.y());
    case Shape::sphere:
      return onto_round(p, size.x(), 0.0);
    case Shape::capsule:
      return onto_round(p, size.x(), 0.5 * size.y());
    case Shape::mesh:
      break;
  }
  return {};
}

}  // namespace cellmirror
