// The circle through three points. Real-time class: any.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "rt_core/base/real_time.hpp"

namespace cellmirror::motion {

// A displacement along a circle: at the share s it is the rotation of `spoke` by s * angle about `normal`, less
// `spoke`.
struct Arc {
  Eigen::Vector3d spoke = Eigen::Vector3d::Zero();    // m; from the centre to where it begins
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // of its plane, perpendicular to the spoke; a unit vector
  double angle = 0;                                   // rad, within (0, 2 pi); 0: no arc

  // From `start` through `via` to `goal` (m). Nothing where two of them are one point or all lie on one line, to
  // rounding. Circumcentre by the vector formula |a|^2 b - |b|^2 a, crossed with a x b, over 2 |a x b|^2.
  [[nodiscard]] static std::optional<Arc> through(const Eigen::Vector3d& start, const Eigen::Vector3d& via,
                                                  const Eigen::Vector3d& goal) CELL_RT;

  [[nodiscard]] double radius() const CELL_RT;
  [[nodiscard]] Eigen::Vector3d displacement(double s) const CELL_RT;
  [[nodiscard]] Eigen::Vector3d velocity(
      double s) const CELL_RT;  // of the displacement, for a share that grows by 1 a second
};

}  // namespace cellmirror::motion
