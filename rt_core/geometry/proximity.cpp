#include "rt_core/geometry/proximity.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rt_core/geometry/inside.hpp"
#include "rt_core/geometry/proximity_mesh.hpp"
#include "rt_core/geometry/proximity_order.hpp"

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

Separation inside_at(const Vector3d& p) {
  Separation out;
  out.points = {0.0, p, p};
  return out;
}

Separation meshes(const Placed& a, const Placed& b, const Pose& X_AB, double up_to, double enough,
                  ProximityHint& hint) {
  Separation out = mesh_mesh_separation(*a.solid.tree, *b.solid.tree, X_AB, up_to, enough, hint);
  if (!out.beyond && out.points.distance < kTouchDistance) return out;
  Vector3d p;
  if (contains_a_shell(*a.solid.tree, *b.solid.tree, X_AB, p)) return inside_at(p);
  if (contains_a_shell(*b.solid.tree, *a.solid.tree, X_AB.inverse(), p)) return inside_at(X_AB * p);
  return out;
}

Separation mesh_and_primitive(const Placed& a, const Placed& b, const Pose& X_AB, double up_to, double enough,
                              ProximityHint& hint) {
  Separation out = mesh_primitive_separation(*a.solid.tree, b.solid.core, X_AB, up_to, enough, hint);
  if (!out.beyond && out.points.distance < kTouchDistance) return out;
  // A primitive holds a sphere as large as its least half extent; where that sticks out of the box, all does not fit.
  const Vector3d p = X_AB.translation();
  const double within = b.solid.half.minCoeff();
  if (((p - a.solid.centre).cwiseAbs().array() + within > a.solid.half.array() + kTouchDistance).any()) return out;
  if (contains(*a.solid.tree, p)) return inside_at(p);
  return out;
}

Separation ordered(const Placed& a, const Placed& b, double up_to, double enough, ProximityHint& hint) {
  const Vector3d between = b.X_W * b.solid.centre - a.X_W * a.solid.centre;
  const double bound = between.norm() - a.solid.radius - b.solid.radius;
  if (!std::isfinite(bound)) {
    Separation doubt;  // an invalid pose; everything may touch
    doubt.certain = false;
    return doubt;
  }
  Separation out;
  if (bound > up_to) {
    out.points.distance = bound;
    out.beyond = true;
    return out;
  }
  if (a.solid.shape != Shape::mesh) {
    const ConvexDistance found = convex_distance(a.solid.core, a.X_W, b.solid.core, b.X_W);
    out.points = found.points;
    out.certain = found.certain;
    out.beyond = !(found.points.distance < up_to);
    return out;
  }
  const Pose X_AB = a.X_W.inverse(Eigen::Isometry) * b.X_W;
  out = b.solid.shape == Shape::mesh ? meshes(a, b, X_AB, up_to, enough, hint)
                                     : mesh_and_primitive(a, b, X_AB, up_to, enough, hint);
  out.points.p_a = a.X_W * out.points.p_a;
  out.points.p_b = a.X_W * out.points.p_b;
  return out;
}

Separation query(const Solid& a, const Pose& X_WA, const Solid& b, const Pose& X_WB, double up_to, double enough,
                 ProximityHint& hint) {
  const Placed first{a, X_WA};
  const Placed second{b, X_WB};
  if (comes_first(first, second)) return ordered(first, second, up_to, enough, hint);
  std::swap(hint.feature_a, hint.feature_b);
  Separation out = ordered(second, first, up_to, enough, hint);
  std::swap(hint.feature_a, hint.feature_b);
  std::swap(out.points.p_a, out.points.p_b);
  return out;
}

}  // namespace

Separation separation(const Solid& a, const Pose& X_WA, const Solid& b, const Pose& X_WB, double up_to,
                      ProximityHint& hint) noexcept {
  // So that contact is reported for any requested distance.
  return query(a, X_WA, b, X_WB, std::max(up_to, kTouchDistance), 0.0, hint);
}

bool touch(const Solid& a, const Pose& X_WA, const Solid& b, const Pose& X_WB, ProximityHint& hint) noexcept {
  return !query(a, X_WA, b, X_WB, kTouchDistance, kTouchDistance, hint).beyond;
}

}  // namespace cellmirror::geometry
