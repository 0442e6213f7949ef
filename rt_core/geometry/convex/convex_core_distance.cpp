// Distances of cores: closed forms, and the iteration with its second opinion.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "rt_core/geometry/convex/convex_cylinder.hpp"
#include "rt_core/geometry/convex/convex_gjk.hpp"
#include "rt_core/geometry/convex/convex_pairs.hpp"
#include "rt_core/geometry/triangle.hpp"

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

// m: how near the bounds of an iteration have to come for its answer to be certain, and the part of the size that
// rounding takes from bodies of more than 10 m.
constexpr double kCertain = 5e-10;
constexpr double kCertainPart = 5e-11;
// m: bounds as near as this need no refinement.
constexpr double kSettled = 1e-12;

CoreDistance answer(const ClosestPoints& points) { return {points.distance, true, false, points.p_a, points.p_b}; }
CoreDistance answer(const Vector3d& p_a, const Vector3d& p_b) { return {(p_b - p_a).norm(), true, false, p_a, p_b}; }

double up_to_less(double value, double limit) { return std::min(std::max(value, -limit), limit); }

CoreDistance box_to_point(const Vector3d& half, const Vector3d& p) {
  return answer({up_to_less(p[0], half[0]), up_to_less(p[1], half[1]), up_to_less(p[2], half[2])}, p);
}

CoreDistance few_to_few(const FewPoints& a, const FewPoints& b, double up_to) {
  if (a.count > b.count) {
    CoreDistance out = few_to_few(b, a, up_to);
    std::swap(out.p_a, out.p_b);
    return out;
  }
  if (a.count == 1) {
    const Vector3d& p = a.points[0];
    if (b.count == 1) return answer(p, b.points[0]);
    if (b.count == 2) return answer(p, closest_on_segment(p, {b.points[0], b.points[1]}));
    return answer(p, closest_on_triangle(p, b.points));
  }
  if (a.count == 2) {
    const Segment s{a.points[0], a.points[1]};
    if (b.count == 2) return answer(segment_segment(s, {b.points[0], b.points[1]}));
    return answer(segment_triangle(s, b.points));
  }
  CoreDistance out = answer(triangle_triangle(a.points, b.points, up_to));
  out.beyond = out.distance >= up_to;
  return out;
}

CoreDistance with_bounds(const GjkAnswer& found, double size) {
  CoreDistance out{found.upper, true, found.beyond, found.p_a, found.p_b};
  if (found.beyond) {
    out.distance = found.lower;
  } else if (found.upper - found.lower > kCertain + kCertainPart * size) {
    out.distance = found.lower;
    out.certain = false;
  }
  return out;
}

// Corner i of a box: bit 0, 1, 2 give the side in x, y, z.
Vector3d corner(const Vector3d& half, unsigned i) {
  return {(i & 1U) != 0 ? half[0] : -half[0], (i & 2U) != 0 ? half[1] : -half[1], (i & 4U) != 0 ? half[2] : -half[2]};
}

using BoxTriangles = std::array<Triangle, 12>;

BoxTriangles triangles_of(const Vector3d& half, const Eigen::Matrix3d& R, const Vector3d& t) {
  constexpr std::array<std::array<unsigned, 4>, 6> kFaces{
      {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}}};
  BoxTriangles out;
  for (std::size_t i = 0; i < kFaces.size(); ++i) {
    std::array<Vector3d, 4> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = t + R * corner(half, kFaces[i][k]);
    out[2 * i] = {p[0], p[1], p[2]};
    out[2 * i + 1] = {p[0], p[2], p[3]};
  }
  return out;
}

bool within(const Vector3d& half, const Vector3d& p) {
  return std::abs(p[0]) <= half[0] && std::abs(p[1]) <= half[1] && std::abs(p[2]) <= half[2];
}

void keep_nearest(const Triangle& a, const Triangle& b, ClosestPoints& best) {
  const ClosestPoints found = triangle_triangle(a, b, best.distance);
  if (found.distance < best.distance) best = found;
}

// Where rounding kept the iteration from closing the gap: every triangle of the one against every of the other. Slow
// and sure.
CoreDistance box_by_triangles(const Vector3d& half, const FewPoints& b) {
  if (within(half, b.points[0])) return answer(b.points[0], b.points[0]);
  const Triangle other{b.points[0], b.points[b.count > 1 ? 1 : 0], b.points[b.count > 2 ? 2 : 0]};
  ClosestPoints best;
  best.distance = std::numeric_limits<double>::infinity();
  for (const Triangle& own : triangles_of(half, Eigen::Matrix3d::Identity(), Vector3d::Zero())) {
    keep_nearest(own, other, best);
  }
  return answer(best);
}

CoreDistance boxes_by_triangles(const Vector3d& half_a, const Vector3d& half_b, const RelativePose& X_AB) {
  if (within(half_a, X_AB.t)) return answer(X_AB.t, X_AB.t);
  const Vector3d own = -(X_AB.R.transpose() * X_AB.t);
  if (within(half_b, own)) return answer(Vector3d::Zero(), Vector3d::Zero());
  const BoxTriangles others = triangles_of(half_b, X_AB.R, X_AB.t);
  ClosestPoints best;
  best.distance = std::numeric_limits<double>::infinity();
  for (const Triangle& a : triangles_of(half_a, Eigen::Matrix3d::Identity(), Vector3d::Zero())) {
    for (const Triangle& b : others) keep_nearest(a, b, best);
  }
  return answer(best);
}

CoreDistance box_to_few(const CentredBox& box, const FewPoints& b, const GjkLimits& limits) {
  if (b.count == 1) return box_to_point(box.half, b.points[0]);
  CoreDistance out = with_bounds(gjk(box, b, -b.points[0], limits), limits.size);
  return out.certain ? out : box_by_triangles(box.half, b);
}

CoreDistance box_to_box(const CentredBox& a, const Placed<CentredBox>& b, const RelativePose& X_AB,
                        const GjkLimits& limits) {
  CoreDistance out = with_bounds(gjk(a, b, -b.t, limits), limits.size);
  return out.certain ? out : boxes_by_triangles(a.half, b.shape.half, X_AB);
}

CoreDistance cylinder_to_box(const CentredCylinder& a, const Placed<CentredBox>& b, const GjkLimits& limits) {
  const GjkAnswer found = gjk(a, b, -b.t, limits);
  CoreDistance out{found.upper, true, found.beyond, found.p_a, found.p_b};
  if (found.beyond) {
    out.distance = found.lower;
  } else if (found.upper - found.lower > kSettled) {
    refine_cylinder_to_box(a, b, out);
  }
  return out;
}

CoreDistance cylinder_to_cylinder(const CentredCylinder& a, const Placed<CentredCylinder>& b, const GjkLimits& limits) {
  const GjkAnswer found = gjk(a, b, -b.t, limits);
  if (found.beyond || found.overlap || found.upper - found.lower <= kSettled) return with_bounds(found, limits.size);
  CoreDistance out{found.upper, true, false, found.p_a, found.p_b};
  refine_cylinder_to_cylinder(a, b, out);
  if (out.distance <= 0.0) return out;
  // The plane between the refined points is a bound, too.
  const Vector3d n = (out.p_b - out.p_a) / out.distance;
  const double plane = dot(n, b.support(-n)) - dot(n, a.support(n));
  const double lower = std::max(found.lower, plane);
  if (out.distance - lower > kCertain + kCertainPart * limits.size) {
    out.distance = lower;
    out.certain = false;
  }
  return out;
}

}  // namespace

double size_of(const ConvexCore& a, const ConvexCore& b, const RelativePose& X_AB) noexcept {
  const auto reach = [](const ConvexCore& core) {
    if (core.kind != CoreKind::triangle) return core.half[0] + core.half[1] + core.half[2];
    return 2.0 * std::max({core.corners[0].cwiseAbs().maxCoeff(), core.corners[1].cwiseAbs().maxCoeff(),
                           core.corners[2].cwiseAbs().maxCoeff()});
  };
  return reach(a) + reach(b) + X_AB.t.cwiseAbs().maxCoeff();
}

CoreDistance core_distance(const ConvexCore& a, const ConvexCore& b, const RelativePose& X_AB, double up_to) noexcept {
  if (has_few_points(a)) return few_to_few(few_points(a), few_points(b, X_AB), up_to);
  GjkLimits limits;
  limits.size = size_of(a, b, X_AB);
  limits.up_to = up_to;
  if (a.kind == CoreKind::box) {
    const CentredBox box{a.half};
    if (has_few_points(b)) return box_to_few(box, few_points(b, X_AB), limits);
    return box_to_box(box, {{b.half}, X_AB.R, X_AB.t}, X_AB, limits);
  }
  const CentredCylinder cylinder{a.half[0], a.half[2]};
  if (has_few_points(b)) {
    const FewPoints few = few_points(b, X_AB);
    if (few.count == 1) return cylinder_to_point(cylinder, few.points[0]);
    if (few.count == 2) return cylinder_to_segment(cylinder, {few.points[0], few.points[1]});
    return cylinder_to_triangle(cylinder, few.points, up_to);
  }
  if (b.kind == CoreKind::box) return cylinder_to_box(cylinder, {{b.half}, X_AB.R, X_AB.t}, limits);
  return cylinder_to_cylinder(cylinder, {{b.half[0], b.half[2]}, X_AB.R, X_AB.t}, limits);
}

}  // namespace cellmirror::geometry
