// The common part of two triangles: one is cut by the other's plane, and what remains by the other's edges.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "rt_core/geometry/triangle.hpp"

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

// Parts of the greatest length of a pair: heights below this are rounding.
constexpr double kRounding = 1e-14;

struct Plane {
  Vector3d normal = Vector3d::Zero();  // unit vector
  bool usable = false;

  explicit Plane(const Triangle& t) {
    const Vector3d u = t[1] - t[0];
    const Vector3d v = t[2] - t[0];
    const Vector3d n = u.cross(v);
    const double nn = n.squaredNorm();
    usable = nn > 1e-26 * u.squaredNorm() * v.squaredNorm();
    if (usable) normal = n / std::sqrt(nn);
  }
};

double greatest_length(const Triangle& a, const Triangle& b) {
  double squared = 0.0;
  for (const Triangle& t : {a, b}) {
    for (const Vector3d& corner : t) squared = std::max(squared, (corner - a[0]).squaredNorm());
  }
  return std::sqrt(squared);
}

// Keeps the part of a segment in the plane of `t` that lies within t; false if none is left.
bool clip(Segment& s, const Triangle& t, const Plane& plane, double tolerance) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d edge = t[i == 2 ? 0 : i + 1] - t[i];
    const double length = edge.norm();
    if (!(length > 0.0)) continue;
    const Vector3d inwards = plane.normal.cross(edge) / length;
    const double from = inwards.dot(s.from - t[i]);
    const double to = inwards.dot(s.to - t[i]);
    if (from < -tolerance && to < -tolerance) return false;
    if ((from < 0.0) == (to < 0.0)) continue;
    const Vector3d crossing = s.from + (from / (from - to)) * (s.to - s.from);
    (from < 0.0 ? s.from : s.to) = crossing;
  }
  return true;
}

// The cut of t by a plane, given the corners' heights over it; false where t does not reach the plane.
bool cut(const Triangle& t, const std::array<double, 3>& heights, Segment& out) {
  int found = 0;
  const auto add = [&](const Vector3d& p) {
    (found == 0 ? out.from : out.to) = p;
    if (found == 0) out.to = p;
    ++found;
  };
  for (std::size_t i = 0; i < 3 && found < 2; ++i) {
    const std::size_t next = i == 2 ? 0 : i + 1;
    if (heights[i] == 0.0) add(t[i]);
    if (found < 2 && heights[i] * heights[next] < 0.0) {
      add(t[i] + (heights[i] / (heights[i] - heights[next])) * (t[next] - t[i]));
    }
  }
  return found > 0;
}

// Of coplanar triangles: the longest part of an edge of either that lies in the other.
bool longest_common_edge(const Triangle& a, const Plane& plane_a, const Triangle& b, const Plane& plane_b,
                         double tolerance, Segment& common) {
  double longest = -1.0;
  const auto consider = [&](const Triangle& edges, const Triangle& other, const Plane& plane) {
    if (!plane.usable) return;
    for (std::size_t i = 0; i < 3; ++i) {
      Segment part{edges[i], edges[i == 2 ? 0 : i + 1]};
      if (!clip(part, other, plane, tolerance)) continue;
      const double length = (part.to - part.from).norm();
      if (!(length > longest)) continue;
      longest = length;
      common = part;
    }
  };
  consider(a, b, plane_b);
  consider(b, a, plane_a);
  return longest >= 0.0;
}

// 0 where a height is rounding.
bool heights_over(const Triangle& t, const Triangle& other, const Plane& plane, double tolerance,
                  std::array<double, 3>& heights) {
  bool coplanar = true;
  for (std::size_t i = 0; i < 3; ++i) {
    heights[i] = plane.normal.dot(t[i] - other[0]);
    if (std::abs(heights[i]) <= tolerance) heights[i] = 0.0;
    coplanar = coplanar && heights[i] == 0.0;
  }
  return coplanar;
}

}  // namespace

bool triangles_intersect(const Triangle& a, const Triangle& b, Segment& common) CELL_RT {
  const double tolerance = kRounding * greatest_length(a, b);
  const Plane plane_a(a);
  const Plane plane_b(b);
  if (!plane_a.usable && !plane_b.usable) {
    const ClosestPoints nearest = triangle_triangle(a, b);
    common = {nearest.p_a, nearest.p_a};
    return nearest.distance <= tolerance;
  }
  const bool swapped = !plane_b.usable;
  const Triangle& t = swapped ? b : a;
  const Triangle& face = swapped ? a : b;
  const Plane& plane = swapped ? plane_a : plane_b;
  std::array<double, 3> heights{};
  if (heights_over(t, face, plane, tolerance, heights)) {
    return longest_common_edge(a, plane_a, b, plane_b, tolerance, common);
  }
  return cut(t, heights, common) && clip(common, face, plane, tolerance);
}

}  // namespace cellmirror::geometry
