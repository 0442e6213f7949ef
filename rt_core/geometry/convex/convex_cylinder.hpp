// Distances of a cylinder about the z axis of the frame. The distance of a point is a closed form and convex, so that
// of a segment is the one root of a rising function; faces add the point in which the cylinder reaches farthest towards
// their plane. Private to this folder.
#pragma once

#include <Eigen/Core>

#include "rt_core/geometry/convex/convex_pairs.hpp"
#include "rt_core/geometry/convex/convex_support.hpp"
#include "rt_core/geometry/triangle.hpp"

namespace cellmirror::geometry {

// Nearest point of the cylinder (of which the inside is part).
[[nodiscard]] Eigen::Vector3d nearest_of(const CentredCylinder& cylinder, const Eigen::Vector3d& p) noexcept;

[[nodiscard]] CoreDistance cylinder_to_point(const CentredCylinder& cylinder, const Eigen::Vector3d& p) noexcept;
[[nodiscard]] CoreDistance cylinder_to_segment(const CentredCylinder& cylinder, const Segment& s) noexcept;
[[nodiscard]] CoreDistance cylinder_to_triangle(const CentredCylinder& cylinder, const Triangle& t,
                                                double up_to) noexcept;
// Better answers to what the iteration over support functions has found: it comes near the nearest points of curved
// bodies, but runs out of digits before it is there.
void refine_cylinder_to_box(const CentredCylinder& cylinder, const Placed<CentredBox>& box,
                            CoreDistance& found) noexcept;
void refine_cylinder_to_cylinder(const CentredCylinder& cylinder, const Placed<CentredCylinder>& other,
                                 CoreDistance& found) noexcept;

}  // namespace cellmirror::geometry
