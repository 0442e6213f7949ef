// How far a point is outside of a rigid body, or how deep in it.
#pragma once

#include <Eigen/Core>

#include "rt_core/geometry/proximity.hpp"
#include "rt_core/geometry/solid.hpp"

namespace cellmirror::tissue {

struct RigidDistance {
  double distance = 0;                                // m; negative: inside
  Eigen::Vector3d nearest = Eigen::Vector3d::Zero();  // on the surface
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit vector, outwards
  bool known = false;  // false: farther than requested, or on an open mesh without a side
};

// In the solid's frame. Exact; an open mesh counts from the side on which p is. `hint` as in proximity.hpp.
[[nodiscard]] RigidDistance rigid_distance(const geometry::Solid& solid, const Eigen::Vector3d& p, double up_to,
                                           geometry::ProximityHint& hint);

}  // namespace cellmirror::tissue
