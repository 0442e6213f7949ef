#include "rt_core/collision/bounds.hpp"

namespace cellmirror::collision {

OrientedBox box_around(const BodyPart& part) {
  OrientedBox box;
  box.X_NB = part.X_NG;
  box.X_NB.translation() = part.X_NG * part.solid->centre;
  box.half = part.solid->half;
  return box;
}

OrientedBox box_around(const Body& body) {
  if (body.parts.size() == 1) return box_around(body.parts.front());
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(1e300);
  Eigen::Vector3d upper = -lower;
  for (const BodyPart& part : body.parts) {
    const OrientedBox box = box_around(part);
    const Eigen::Vector3d reach = box.X_NB.linear().cwiseAbs() * box.half;
    lower = lower.cwiseMin(box.X_NB.translation() - reach);
    upper = upper.cwiseMax(box.X_NB.translation() + reach);
  }
  OrientedBox box;
  box.X_NB.translation() = 0.5 * (lower + upper);
  box.half = 0.5 * (upper - lower);
  return box;
}

Ball ball_around(const Body& body) {
  Ball ball;
  ball.centre = box_around(body).X_NB.translation();
  for (const BodyPart& part : body.parts) {
    const Eigen::Vector3d centre = part.X_NG * part.solid->centre;
    ball.radius = std::max(ball.radius, (centre - ball.centre).norm() + part.solid->radius);
  }
  return ball;
}

double box_gap(const PlacedBox& a, const PlacedBox& b) {
  const Eigen::Matrix3d R_AB = a.R.transpose() * b.R;
  const Eigen::Matrix3d size = R_AB.cwiseAbs();
  const Eigen::Vector3d p = b.centre - a.centre;
  const Eigen::Vector3d in_a = (a.R.transpose() * p).cwiseAbs() - a.half - size * b.half;
  const Eigen::Vector3d in_b = (b.R.transpose() * p).cwiseAbs() - b.half - size.transpose() * a.half;
  return std::sqrt(std::max(in_a.cwiseMax(0.0).squaredNorm(), in_b.cwiseMax(0.0).squaredNorm()));
}

}  // namespace cellmirror::collision
