#include "rt_core/motion/arc.hpp"

#include <numbers>

namespace cellmirror::motion {

std::optional<Arc> Arc::through(const Eigen::Vector3d& start, const Eigen::Vector3d& via,
                                const Eigen::Vector3d& goal) CELL_RT {
  constexpr double kSamePoint = 1e-6;  // m
  constexpr double kOnOneLine = 1e-5;  // of the sine of the angle at the start: 1 um of sagitta on 200 mm
  const Eigen::Vector3d a = via - start;
  const Eigen::Vector3d b = goal - start;
  const Eigen::Vector3d n = a.cross(b);
  if (!(a.norm() > kSamePoint && b.norm() > kSamePoint && (goal - via).norm() > kSamePoint)) return std::nullopt;
  if (!(n.norm() > kOnOneLine * a.norm() * b.norm())) return std::nullopt;
  Arc arc;
  arc.spoke = -(a.squaredNorm() * b - b.squaredNorm() * a).cross(n) / (2 * n.squaredNorm());
  arc.normal = n.normalized();
  const Eigen::Vector3d last = b + arc.spoke;
  arc.angle = std::atan2(arc.normal.dot(arc.spoke.cross(last)), arc.spoke.dot(last));
  if (arc.angle <= 0) arc.angle += 2 * std::numbers::pi;
  return arc;
}

double Arc::radius() const CELL_RT { return spoke.norm(); }

Eigen::Vector3d Arc::displacement(double s) const CELL_RT {
  return (std::cos(s * angle) - 1) * spoke + std::sin(s * angle) * normal.cross(spoke);
}

Eigen::Vector3d Arc::velocity(double s) const CELL_RT {
  return angle * (std::cos(s * angle) * normal.cross(spoke) - std::sin(s * angle) * spoke);
}

}  // namespace cellmirror::motion
