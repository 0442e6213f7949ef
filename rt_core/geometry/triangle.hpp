// Exact queries between points, segments and triangles. All in one frame; m. Degenerate input (a segment of no length,
// a flat triangle) is answered as the segment or point that it is. No heap memory, noexcept. Source: Ericson, Real-Time
// Collision Detection, chapter 5 (closest points); Moeller 1997 and Guigue, Devillers 2003 (triangles that intersect).
#pragma once

#include <Eigen/Core>
#include <array>

#include "rt_core/base/real_time.hpp"
#include "rt_core/geometry/closest.hpp"

namespace cellmirror::geometry {

using Triangle = std::array<Eigen::Vector3d, 3>;

struct Segment {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
};

[[nodiscard]] Eigen::Vector3d closest_on_segment(const Eigen::Vector3d& p, const Segment& s) CELL_RT;
[[nodiscard]] Eigen::Vector3d closest_on_triangle(const Eigen::Vector3d& p, const Triangle& t) CELL_RT;
[[nodiscard]] ClosestPoints segment_segment(const Segment& a, const Segment& b) CELL_RT;
[[nodiscard]] ClosestPoints segment_triangle(const Segment& a, const Triangle& b) CELL_RT;    // 0 where it pierces
[[nodiscard]] ClosestPoints triangle_triangle(const Triangle& a, const Triangle& b) CELL_RT;  // 0 where they intersect
// The same in less time where only a distance below `up_to` is of interest: from there on `distance` may be any lower
// bound that is not below `up_to`, and the points are not set.
[[nodiscard]] ClosestPoints triangle_triangle(const Triangle& a, const Triangle& b, double up_to) CELL_RT;
// The line in which two triangles intersect, as a segment (of no length where they touch in a point); false where they
// do not. Coplanar triangles that overlap give a segment within the overlap.
[[nodiscard]] bool triangles_intersect(const Triangle& a, const Triangle& b, Segment& common) CELL_RT;

}  // namespace cellmirror::geometry
