#include "rt_core/geometry/proximity_mesh.hpp"

#include <algorithm>

#include "rt_core/geometry/box_walk.hpp"
#include "rt_core/geometry/pair_walk.hpp"

namespace cellmirror::geometry {

namespace {

Triangle moved(const Triangle& t, const Pose& X) { return {X * t[0], X * t[1], X * t[2]}; }

}  // namespace

Separation mesh_mesh_separation(const MeshTree& a, const MeshTree& b, const Pose& X_AB, double up_to, double enough,
                                ProximityHint& hint) noexcept {
  Separation best;
  best.points.distance = up_to;
  best.beyond = true;
  const auto look_at = [&](std::uint32_t i, std::uint32_t k) {
    const Triangle in_a = moved(b.triangles()[k], X_AB);
    const ClosestPoints points = triangle_triangle(a.triangles()[i], in_a, best.points.distance);
    if (!(points.distance < best.points.distance)) return false;
    best.points = points;
    best.beyond = false;
    hint = {i, k, true};
    return true;
  };
  if (hint.known && hint.feature_a < a.triangles().size() && hint.feature_b < b.triangles().size()) {
    look_at(hint.feature_a, hint.feature_b);
  }
  PairWalk walk(a.wide(), b.wide(), X_AB);
  walk.set_limit(best.points.distance);
  std::uint32_t i = 0;
  std::uint32_t k = 0;
  while (!(best.points.distance <= enough && !best.beyond) && walk.next(i, k)) {
    if (look_at(i, k)) walk.set_limit(best.points.distance);
  }
  if (best.beyond) best.points.distance = std::max(up_to, walk.least_left_out());
  return best;
}

Separation mesh_primitive_separation(const MeshTree& mesh, const ConvexCore& primitive, const Pose& X_MP, double up_to,
                                     double enough, ProximityHint& hint) noexcept {
  Separation best;
  best.points.distance = up_to;
  best.beyond = true;
  ConvexCore triangle;
  triangle.kind = CoreKind::triangle;
  const auto look_at = [&](std::uint32_t i) {
    triangle.corners = mesh.triangles()[i];
    const ConvexDistance found = convex_distance(triangle, Pose::Identity(), primitive, X_MP);
    if (!(found.points.distance < best.points.distance)) return false;
    best.points = found.points;
    best.certain = found.certain;
    best.beyond = false;
    hint = {i, 0, true};
    return true;
  };
  if (hint.known && hint.feature_a < mesh.triangles().size()) look_at(hint.feature_a);
  BoxWalk walk(mesh.wide(), X_MP, primitive.half, primitive.skin);
  walk.set_limit(best.points.distance);
  std::uint32_t i = 0;
  while (!(best.points.distance <= enough && !best.beyond) && walk.next(i)) {
    if (look_at(i)) walk.set_limit(best.points.distance);
  }
  if (best.beyond) best.points.distance = std::max(up_to, walk.least_left_out());
  return best;
}

}  // namespace cellmirror::geometry
