// Parts of spheres, for capsules. Private to this folder.
#pragma once

#include <Eigen/Core>

#include "rt_core/ranging/cone_section.hpp"

namespace cellmirror::ranging {

// A plane through the sphere's centre beyond which its surface is that of the body.
struct Seam {
  bool there = false;
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();  // unit vector
  [[nodiscard]] bool keeps(const Eigen::Vector3d& from_centre) const {
    return !there || outward.dot(from_centre) >= 0.0;
  }
};

// Points beyond the seam only. What is nearest of all allowed points on the seam itself need not be found.
void nearest_on_sphere_from_outside(const ConeShape& cone, const Eigen::Vector3d& c, double r, const Seam& seam,
                                    Nearest& best);
// The points where beams leave the sphere.
void nearest_on_sphere_from_inside(const ConeShape& cone, const Eigen::Vector3d& c, double r, const Seam& seam,
                                   Nearest& best);

}  // namespace cellmirror::ranging
