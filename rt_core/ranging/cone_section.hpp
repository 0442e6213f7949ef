// The nearest point within a cone of flat things: segments, triangles, rectangles. Private to this folder.
//
// A flat convex face T and the cone C are both convex, and so is what of them is common; the point x of it that is
// nearest to the apex is therefore unique. Let q be the nearest point of the face's whole plane within the cone, a
// closed form. Where q lies in T, x is q. Otherwise x lies on an edge beyond which q lies: from any point within both,
// the way to q stays in C and gets nearer to the apex, so x is where that way leaves T. An edge is cut by the cone in
// the roots of a quadratic.
//
// The beam's incidence on a plane at the distance d from the apex is acos(d / |p|): it grows with |p| alone. So the
// nearest point within the cone is also the one that is met most squarely, and a limit of the incidence is a limit of
// the distance, d / cos(limit), of that face.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>

#include "rt_core/geometry/triangle.hpp"

namespace cellmirror::ranging {

// Apex at the origin, opening along z.
struct ConeShape {
  double sine = 0;  // of the half-angle
  double cosine = 1;
  double cos_incidence = 0;  // of the greatest angle of incidence; 0: any

  // Rounding must not open a gap between two faces that share an edge on the cone's surface.
  static constexpr double kSlack = 1e-14;

  [[nodiscard]] bool holds(const Eigen::Vector3d& p) const {
    const double inward = sine * p.z();
    const double outward = cosine * cosine * (p.x() * p.x() + p.y() * p.y());
    return p.z() >= 0.0 && inward * inward * (1.0 + kSlack) >= outward;
  }
  // How far beyond the lateral surface, m, for points beside it; a convex function, negative inside.
  [[nodiscard]] double beyond(const Eigen::Vector3d& p) const {
    return cosine * std::sqrt(p.x() * p.x() + p.y() * p.y()) - sine * p.z();
  }
  // The farthest that a point of a plane at the distance `d` from the apex may be.
  [[nodiscard]] double reach(double d, double limit) const {
    constexpr double kRounding = 1e-12;  // and an apex that lies on a surface touches it, whatever the beam
    return cos_incidence > 0.0 ? std::fmin(limit, d / cos_incidence * (1.0 + kRounding) + kRounding) : limit;
  }
};

// The best point so far.
struct Nearest {
  double distance = 0;  // m; at the start the limit, which has to be beaten
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  bool found = false;

  void offer(double at, const Eigen::Vector3d& point) {
    if (!(at < distance)) return;
    distance = at;
    p = point;
    found = true;
  }
};

// The nearest point within the cone of the whole plane of points p with normal . p == d; false: the plane misses the
// cone. `normal`: of unit length, d not negative.
[[nodiscard]] bool nearest_on_plane(const ConeShape& cone, const Eigen::Vector3d& normal, double d, Eigen::Vector3d& q);

// Any incidence. Only points nearer than `limit`.
[[nodiscard]] bool nearest_on_segment(const ConeShape& cone, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                      double limit, Eigen::Vector3d& p);

// The corners of a flat convex polygon in order, either way round; of triangles also flat ones, which are segments:
// their normals are all directions across.
void nearest_on_polygon(const ConeShape& cone, std::span<const Eigen::Vector3d> corners, Nearest& best);

}  // namespace cellmirror::ranging
