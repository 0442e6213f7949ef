// The nearest point within a cone of spheres, cylinders and capsules. Private to this folder.
#pragma once

#include <Eigen/Core>

#include "rt_core/base/pose.hpp"
#include "rt_core/ranging/cone_section.hpp"

namespace cellmirror::ranging {

// The whole surface, from outside and inside. Closed form.
void nearest_on_sphere(const ConeShape& cone, const Eigen::Vector3d& centre, double radius, Nearest& best);

// Along z of its frame G, centred there; from outside and inside.
void nearest_on_cylinder(const ConeShape& cone, const Pose& X_SG, double radius, double half_length, Nearest& best);
void nearest_on_capsule(const ConeShape& cone, const Pose& X_SG, double radius, double half_length, Nearest& best);

}  // namespace cellmirror::ranging
