// How far two overlapping cores reach into each other along a direction, and the direction along which it is least.
// Private to this folder.
#pragma once

#include <Eigen/Core>

#include "rt_core/geometry/convex/convex_pairs.hpp"

namespace cellmirror::geometry {

struct LeastOverlap {
  double depth = 0;                                   // m
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // from A to B, in frame A
};

// `a` comes first (comes_first()). Exact for polytopes: the difference of two has no faces but those of either and
// those that two edges span. With cylinders to 1e-9 of the size.
[[nodiscard]] LeastOverlap least_overlap(const ConvexCore& a, const ConvexCore& b, const RelativePose& X_AB) noexcept;

}  // namespace cellmirror::geometry
