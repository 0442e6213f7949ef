// Distance and overlap of convex shapes: points, segments, boxes, cylinders and triangles, each with a skin of constant
// thickness (a sphere is a point with a skin, a capsule a segment). Never fails: if an iteration does not converge, the
// result is a bound with `certain == false`. No heap memory, noexcept. Source: Gilbert, Johnson, Keerthi 1988
// (distance); van den Bergen 2001 (penetration); closed forms where they exist.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/geometry/closest.hpp"

namespace cellmirror::geometry {

enum class CoreKind : std::uint8_t { point, segment, box, cylinder, triangle };

// In its own frame G: a point at the origin; a segment, a cylinder along z, centred; a box centred; a triangle
// anywhere.
struct ConvexCore {
  CoreKind kind = CoreKind::point;
  Eigen::Vector3d half = Eigen::Vector3d::Zero();  // box: half edges; segment: (0, 0, half length);
                                                   // cylinder: (radius, radius, half length); m
  std::array<Eigen::Vector3d, 3> corners{};        // triangle
  double skin = 0;                                 // m, not negative
};

struct ConvexDistance {
  ClosestPoints points;  // of the surfaces with their skins, in frame W
  bool certain = true;  // false: `points.distance` is a lower bound, at most 1e-6 m too small; 0 if input is not finite
};

// Accurate to 1e-9 m for bodies up to 10 m (1e-12 where a closed form exists), whatever the poses: touching, identical,
// nested, flat, parallel, a million times different in size.
[[nodiscard]] ConvexDistance convex_distance(const ConvexCore& a, const Pose& X_WA, const ConvexCore& b,
                                             const Pose& X_WB) CELL_RT;
// The same in less time where only a distance below `up_to` (m, not negative) is of interest: from there on
// points.distance may be any lower bound that is not below `up_to`, and the points are not set.
[[nodiscard]] ConvexDistance convex_distance(const ConvexCore& a, const Pose& X_WA, const ConvexCore& b,
                                             const Pose& X_WB, double up_to) CELL_RT;
// Of shapes whose convex_distance is 0 (else depth 0).
[[nodiscard]] Penetration convex_penetration(const ConvexCore& a, const Pose& X_WA, const ConvexCore& b,
                                             const Pose& X_WB) CELL_RT;

}  // namespace cellmirror::geometry
