// Mass, centre of mass and moments of a rigid body in some frame.
#pragma once

#include <Eigen/Core>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::dynamics {

// Moments about the centre of mass, axes parallel to the frame's.
struct Inertia {
  double mass = 0;                                // kg
  Eigen::Vector3d p_C = Eigen::Vector3d::Zero();  // m
  Eigen::Matrix3d I_C = Eigen::Matrix3d::Zero();  // kg m2
};

// The same body in frame A, given in frame B.
[[nodiscard]] Inertia moved(const Inertia& inertia, const Pose& X_AB);
// Both together.
[[nodiscard]] Inertia joined(const Inertia& a, const Inertia& b);
// Nothing that could move: no mass and no moments.
[[nodiscard]] bool is_empty(const Inertia& inertia);
// Refused: what is not finite, a negative mass, moments that are not symmetric or negative about some axis. Moments
// that no body can have (one above the sum of the other two) are taken: published models name only those that matter.
[[nodiscard]] Result<void> check(const Inertia& inertia);

}  // namespace cellmirror::dynamics
