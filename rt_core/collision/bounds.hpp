// Cheap lower bounds of distances: balls, boxes, and how far a body has moved. They may be too small, never too large.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "rt_core/base/pose.hpp"
#include "rt_core/collision/pairs.hpp"

namespace cellmirror::collision {

// What rounding may add to a bound, m: far above that of the sums here, and as much as decides about a touch.
inline constexpr double kBoundSlack = 1e-9;

struct Ball {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // m
  double radius = 0;
};

struct OrientedBox {
  Pose X_NB = Pose::Identity();  // centre and axes, in the node
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
};

// Around all parts of a body, in its node.
[[nodiscard]] Ball ball_around(const Body& body);
[[nodiscard]] OrientedBox box_around(const Body& body);
[[nodiscard]] OrientedBox box_around(const BodyPart& part);

// A box in the world.
struct PlacedBox {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  double radius = 0;  // of a ball about `centre` around what is inside of the box

  void place(const Pose& X_WN, const OrientedBox& box) {
    R.noalias() = X_WN.linear() * box.X_NB.linear();
    centre.noalias() = X_WN.linear() * box.X_NB.translation();
    centre += X_WN.translation();
  }
};

[[nodiscard]] inline double ball_gap(const PlacedBox& a, const PlacedBox& b) {
  return (b.centre - a.centre).norm() - a.radius - b.radius;
}

// The greater of the distances between one box and the other's axis-parallel hull in its axes; negative never.
[[nodiscard]] double box_gap(const PlacedBox& a, const PlacedBox& b);

// The better of both, less what rounding may have added. Negative where the balls overlap and the boxes too.
[[nodiscard]] inline double lower_bound(const PlacedBox& a, const PlacedBox& b, double enough) {
  const double balls = ball_gap(a, b);
  return (balls > enough ? balls : std::max(balls, box_gap(a, b))) - kBoundSlack;
}

// At most how far any point of a body, within `radius` of a point that moved by `shift`, moved from one pose to
// another.
[[nodiscard]] inline double travel(const Eigen::Matrix3d& before, const Eigen::Matrix3d& now, double shift,
                                   double radius) {
  // |now - before| = 2 sin(angle / 2) as an operator, and sqrt(2) times that as a Frobenius norm.
  constexpr double kHalfSqrt2 = 0.70710678118654757;
  return shift + radius * kHalfSqrt2 * (now - before).norm();
}

}  // namespace cellmirror::collision
