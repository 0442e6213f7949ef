// The nearest point of a solid's surface inside a cone. Exact: a wire of any thinness, a face that the cone only
// pierces, a body around the apex. No heap memory, noexcept; any thread, not for the tick.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/solid.hpp"

namespace cellmirror::ranging {

// Apex at the origin of the sensor's frame S, opening along its z axis.
struct Cone {
  double half_angle_rad = 0.13;  // above 0, below pi / 2
  // Beyond this angle between the beam and the surface's normal nothing comes back: the beam model of a real sensor, an
  // ideal one has pi / 2.
  double max_incidence_rad = 1.5707963267948966;
};

struct ConeHit {
  double distance = 0;                            // m, from the apex
  Eigen::Vector3d p_S = Eigen::Vector3d::Zero();  // on the surface, in S
};

// The hit that is nearer than `up_to` (m), if any. Both sides of a surface count. X_SG: the solid in S.
[[nodiscard]] std::optional<ConeHit> nearest_in_cone(const geometry::Solid& solid, const Pose& X_SG, const Cone& cone,
                                                     double up_to) noexcept;

}  // namespace cellmirror::ranging
