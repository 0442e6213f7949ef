// The iteration of Gilbert, Johnson and Keerthi 1988 over two support functions. Private to this folder.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "rt_core/geometry/convex/convex_simplex.hpp"
#include "rt_core/geometry/convex/convex_support.hpp"

namespace cellmirror::geometry {

struct GjkAnswer {
  double upper = 0;  // m, distance of p_a and p_b: not less than the distance
  double lower = 0;  // m, of the best plane between the bodies that was met: not more than the distance
  bool overlap = false;
  bool beyond = false;  // `lower` exceeds the requested distance: the points are not set
  int iterations = 0;
  Eigen::Vector3d p_a = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_b = Eigen::Vector3d::Zero();
};

struct GjkLimits {
  double size = 1;  // m, of both bodies together: the rounding of their points is a part of it
  double up_to = std::numeric_limits<double>::infinity();  // m
  int iterations = 64;
};

// Parts of the size: distances that are rounding, and how near upper and lower bound have to come.
inline constexpr double kGjkZero = 4e-15;
inline constexpr double kGjkGap = 1e-13;

// `v` is any point of the difference A - B, best one near the origin.
template <typename A, typename B>
[[nodiscard]] GjkAnswer gjk(const A& a, const B& b, Eigen::Vector3d v, const GjkLimits& limits) noexcept {
  GjkAnswer out;
  Simplex simplex;
  if (!(dot(v, v) > 0.0)) v = Eigen::Vector3d::UnitX();
  const double zero_squared = (kGjkZero * limits.size) * (kGjkZero * limits.size);
  const double gap_squared = (kGjkGap * limits.size) * (kGjkGap * limits.size);
  const double up_to_squared = limits.up_to * limits.up_to;
  double lower_squared = 0.0;
  for (out.iterations = 1; out.iterations <= limits.iterations; ++out.iterations) {
    const Eigen::Vector3d p_a = a.support(-v);
    const Eigen::Vector3d w = p_a - b.support(v);
    const double vv = dot(v, v);
    const double vw = dot(v, w);
    if (vw > 0.0) {
      const double squared = vw * vw / vv;
      if (squared > lower_squared) lower_squared = squared;
      if (squared > up_to_squared) {
        out.beyond = true;
        break;
      }
    }
    if (out.iterations > 1) {
      const double gap = vv - vw;
      if (gap * gap <= gap_squared * vv || simplex.has(w)) break;
    }
    if (!simplex.add(w, p_a)) break;
    // A tetrahedron that encloses the origin despite a separating plane is a rounding error.
    if (simplex.encloses_origin() || !(simplex.squared() > zero_squared)) {
      out.overlap = !(lower_squared > 4.0 * gap_squared);
      break;
    }
    v = simplex.nearest();
  }
  out.lower = std::sqrt(lower_squared);
  if (out.beyond) return out;
  if (out.overlap) {
    out.lower = 0.0;
    out.p_a = simplex.common_point();
    out.p_b = out.p_a;
    return out;
  }
  // Together they are as far apart, in just the direction, as the simplex is from the origin: weights of slender
  // simplices have fewer digits than that.
  out.p_a = simplex.point_of_a();
  out.p_b = out.p_a - simplex.nearest();
  out.upper = std::sqrt(simplex.squared());
  return out;
}

}  // namespace cellmirror::geometry
