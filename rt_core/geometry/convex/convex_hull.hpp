// The convex hull of points. Not for the tick: O(n log n) with heap memory. Any thread. Source: Quickhull (Barber,
// Dobkin, Huhdanpaa 1996), by Qhull.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

#include "rt_core/base/result.hpp"
#include "rt_core/geometry/triangle_mesh.hpp"

namespace cellmirror::geometry {

// Points may lie outside of a hull by at most this part of their size (diagonal of the box around them).
inline constexpr double kHullTolerance = 1e-10;

// A closed, convex mesh that contains every point. Refused: fewer than four points, points that are not finite, points
// in one plane (up to rounding).
[[nodiscard]] Result<TriangleMesh> convex_hull(std::string name, std::span<const Eigen::Vector3d> points);

}  // namespace cellmirror::geometry
