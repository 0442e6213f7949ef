#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "rt_core/geometry/contact_surfaces.hpp"
#include "rt_core/geometry/inside.hpp"
#include "rt_core/geometry/polytope.hpp"
#include "rt_core/geometry/proximity.hpp"
#include "rt_core/geometry/proximity_mesh.hpp"
#include "rt_core/geometry/proximity_order.hpp"

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

// The prism that approximates a cylinder is too thick: the overlap along the normal, with the cylinder itself.
double overlap_with_cylinder(const Polytope& a, const ConvexCore& b, const Pose& X_AB, const Vector3d& n) {
  const Vector3d n_B = X_AB.linear().transpose() * n;
  double reach = -std::numeric_limits<double>::infinity();
  for (const Vector3d& p : a.corners) reach = std::max(reach, n.dot(p));
  const double reach_of_b = b.half.x() * std::hypot(n_B.x(), n_B.y()) + b.half.z() * std::abs(n_B.z());
  return std::max(0.0, reach - n.dot(X_AB.translation()) + reach_of_b);
}

// Both convex, the first a mesh; in its frame. False where this is not the way to find the depth: the core of a
// primitive is outside, so only its skin touches.
bool polytope_contact(const Placed& a, const Placed& b, const Pose& X_AB, ContactPoint& out) {
  thread_local Polytope in_b;
  thread_local Polytope in_a;
  const bool mesh = b.solid.shape == Shape::mesh;
  if (!mesh) polytope_of(b.solid.core, in_b);
  move_polytope(mesh ? *b.solid.tree->polytope() : in_b, X_AB, in_a);
  PolytopeOverlap overlap = least_overlap(*a.solid.tree->polytope(), in_a);
  if (!(overlap.depth >= 0) || !std::isfinite(overlap.depth)) return false;
  if (!mesh && b.solid.core.kind == CoreKind::cylinder) {
    overlap.depth = overlap_with_cylinder(*a.solid.tree->polytope(), b.solid.core, X_AB, overlap.normal);
  }
  // Where they would touch last if they were moved apart.
  Pose parted = X_AB;
  parted.translation() += overlap.depth * overlap.normal;
  ProximityHint hint;
  constexpr double kAny = std::numeric_limits<double>::infinity();
  ConvexCore core = b.solid.core;
  core.skin = 0;
  const Separation last = mesh ? mesh_mesh_separation(*a.solid.tree, *b.solid.tree, parted, kAny, kTouchDistance, hint)
                               : mesh_primitive_separation(*a.solid.tree, core, parted, kAny, kTouchDistance, hint);
  out.depth = overlap.depth + b.solid.core.skin;
  out.normal = overlap.normal;
  out.p_W = last.points.p_a - 0.5 * out.depth * out.normal;
  return true;
}

// The skin of a convex primitive, whose core is outside, in a convex mesh.
bool skin_contact(const Placed& a, const Placed& b, const Pose& X_AB, ContactPoint& out) {
  ConvexCore core = b.solid.core;
  if (!(core.skin > 0)) return false;
  core.skin = 0;
  ProximityHint hint;
  const Separation apart =
      mesh_primitive_separation(*a.solid.tree, core, X_AB, b.solid.core.skin + kTouchDistance, 0.0, hint);
  if (apart.beyond || !(apart.points.distance > 0)) return false;
  out.normal = (apart.points.p_b - apart.points.p_a) / apart.points.distance;
  out.depth = std::max(0.0, b.solid.core.skin - apart.points.distance);
  out.p_W = apart.points.p_a - 0.5 * out.depth * out.normal;
  return true;
}

bool convex_contact(const Placed& a, const Placed& b, const Pose& X_AB, ContactPoint& out) {
  if (a.solid.tree->polytope() == nullptr) return false;
  if (b.solid.shape == Shape::mesh && b.solid.tree->polytope() == nullptr) return false;
  return polytope_contact(a, b, X_AB, out) || skin_contact(a, b, X_AB, out);
}

// In W, with normals from a to b; a comes first. At least one point.
void find_points(const Placed& a, const Placed& b, const Vector3d& p_W_common, std::vector<ContactPoint>& points) {
  if (a.solid.shape != Shape::mesh) {
    const Penetration found = convex_penetration(a.solid.core, a.X_W, b.solid.core, b.X_W);
    points.push_back({found.depth > 0 ? found.point : p_W_common, found.normal, found.depth});
    return;
  }
  const Pose X_AB = a.X_W.inverse(Eigen::Isometry) * b.X_W;
  ContactPoint convex;
  const bool both_convex = convex_contact(a, b, X_AB, convex);
  if (both_convex) points.push_back(convex);
  if (b.solid.shape == Shape::mesh) {
    mesh_mesh_contact(*a.solid.tree, *b.solid.tree, X_AB, points);
  } else if (!both_convex) {
    mesh_primitive_contact(*a.solid.tree, b.solid.core, X_AB, points);
  }
  for (std::size_t i = both_convex ? 1 : 0; both_convex && i < points.size(); ++i) {
    points[i].depth = std::min(points[i].depth, convex.depth);
  }
  for (ContactPoint& point : points) {
    point.p_W = a.X_W * point.p_W;
    point.normal = a.X_W.linear() * point.normal;
  }
  if (points.empty()) points.push_back({p_W_common, Vector3d::Zero(), 0.0});
}

bool sound(const ContactPoint& point) {
  return std::isfinite(point.depth) && point.depth >= 0 && point.p_W.allFinite() && point.normal.allFinite();
}

// Default direction: from one centre to the other.
Vector3d between_middles(const Placed& a, const Placed& b) {
  const Vector3d n = b.X_W * b.solid.centre - a.X_W * a.solid.centre;
  const double length = n.norm();
  return length > 0 && std::isfinite(length) ? Vector3d(n / length) : Vector3d::UnitZ();
}

// The deepest, then each time the one that is farthest from those taken.
void choose(std::vector<ContactPoint>& from, std::size_t most, std::vector<ContactPoint>& out) {
  thread_local std::vector<double> squares;
  squares.assign(from.size(), std::numeric_limits<double>::infinity());
  std::size_t next = 0;
  for (std::size_t i = 1; i < from.size(); ++i) {
    if (from[i].depth > from[next].depth) next = i;
  }
  while (out.size() < std::min(most, from.size())) {
    out.push_back(from[next]);
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
      squares[i] = std::min(squares[i], (from[i].p_W - out.back().p_W).squaredNorm());
      if (squares[i] > squares[farthest]) farthest = i;
    }
    if (!(squares[farthest] > kTouchDistance * kTouchDistance)) break;
    next = farthest;
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const ContactPoint& a, const ContactPoint& b) { return a.depth > b.depth; });
}

}  // namespace

bool contact(const Solid& a, const Pose& X_WA, const Solid& b, const Pose& X_WB, std::size_t most,
             Contact& out) noexcept {
  out.deepest = {};
  out.points.clear();
  ProximityHint hint;
  const Separation apart = separation(a, X_WA, b, X_WB, kTouchDistance, hint);
  if (apart.beyond) return false;
  const Placed first{a, X_WA};
  const Placed second{b, X_WB};
  const bool in_order = comes_first(first, second);
  thread_local std::vector<ContactPoint> points;
  points.clear();
  const bool finite = X_WA.matrix().allFinite() && X_WB.matrix().allFinite();
  if (finite) find_points(in_order ? first : second, in_order ? second : first, apart.points.p_a, points);
  std::erase_if(points, [](const ContactPoint& point) { return !sound(point); });
  if (points.empty()) points.push_back({finite ? apart.points.p_a : Vector3d::Zero(), Vector3d::Zero(), 0.0});
  const auto deepest =
      std::max_element(points.begin(), points.end(),
                       [](const ContactPoint& one, const ContactPoint& other) { return one.depth < other.depth; });
  Vector3d fallback = deepest->normal;
  if (fallback.isZero()) fallback = between_middles(in_order ? first : second, in_order ? second : first);
  for (ContactPoint& point : points) {
    if (point.normal.isZero()) point.normal = fallback;
    if (!in_order) point.normal = -point.normal;
  }
  out.deepest = *deepest;
  choose(points, most, out.points);
  return true;
}

}  // namespace cellmirror::geometry
