#include "rt_core/geometry/proximity_mesh.hpp"

#include <algorithm>
#include <limits>

#include "rt_core/geometry/box_walk.hpp"
#include "rt_core/geometry/pair_walk.hpp"

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

double dot(const Vector3d& a, const Vector3d& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// The gap between two triangles along n, from a to b; negative where they overlap.
double gap_along(const Vector3d& n, const Triangle& a, const Triangle& b) {
  const double end_of_a = std::max({dot(n, a[0]), dot(n, a[1]), dot(n, a[2])});
  const double start_of_b = std::min({dot(n, b[0]), dot(n, b[1]), dot(n, b[2])});
  return start_of_b - end_of_a;
}

// Of two triangles that share the nearest point with others, all but one are skipped: fraction of the bodies' size by
// which another pair must be nearer to count.
constexpr double kSameDistance = 1e-14;

Triangle moved(const Triangle& t, const Pose& X) { return {X * t[0], X * t[1], X * t[2]}; }

// The nearest pair so far. It may be farther apart than requested: its direction still separates the bodies, and it is
// the hint for the next query.
class Nearest {
 public:
  Nearest(double up_to, double size) : up_to_(up_to), rounding_(kSameDistance * size) {}

  // Whether it is nearer.
  bool offer(const ClosestPoints& points, bool certain, const ProximityHint& features, ProximityHint& hint) {
    if (!(points.distance < points_.distance)) return false;
    points_ = points;
    certain_ = certain;
    hint = features;
    direction_ =
        points.distance > kTouchDistance ? Vector3d((points.p_b - points.p_a) / points.distance) : Vector3d::Zero();
    return true;
  }
  [[nodiscard]] double distance() const { return points_.distance; }
  [[nodiscard]] double limit() const { return std::min(up_to_, points_.distance); }
  [[nodiscard]] const Vector3d& direction() const { return direction_; }
  [[nodiscard]] bool within(double enough) const { return points_.distance <= enough; }
  // Whether the projection on the direction shows that two triangles are too far apart.
  [[nodiscard]] bool apart(const Triangle& a, const Triangle& b) {
    const double gap = gap_along(direction_, a, b);
    if (!(gap > limit() - rounding_ && gap > rounding_)) return false;
    least_left_out_ = std::min(least_left_out_, gap);
    return true;
  }
  [[nodiscard]] Separation answer(double least_left_out) const {
    Separation out;
    out.points = points_;
    out.certain = certain_;
    out.beyond = !(points_.distance < up_to_);
    if (out.beyond)
      out.points.distance = std::max(up_to_, std::min({points_.distance, least_left_out, least_left_out_}));
    return out;
  }

 private:
  double up_to_;
  double rounding_;
  ClosestPoints points_{std::numeric_limits<double>::infinity(), Vector3d::Zero(), Vector3d::Zero()};
  Vector3d direction_ = Vector3d::Zero();
  double least_left_out_ = std::numeric_limits<double>::infinity();
  bool certain_ = true;
};

}  // namespace

Separation mesh_mesh_separation(const MeshTree& a, const MeshTree& b, const Pose& X_AB, double up_to, double enough,
                                ProximityHint& hint) noexcept {
  Nearest nearest(up_to, a.wide().reach() + b.wide().reach());
  PairWalk walk(a.wide(), b.wide(), X_AB);
  walk.set_limit(up_to);
  const auto examine = [&](std::uint32_t i, std::uint32_t k) {
    const Triangle in_a = moved(b.triangles()[k], X_AB);
    if (nearest.apart(a.triangles()[i], in_a)) return;
    const ClosestPoints points = triangle_triangle(a.triangles()[i], in_a, nearest.distance());
    if (!nearest.offer(points, true, {i, k, true}, hint)) return;
    walk.set_limit(nearest.limit());
    walk.set_direction(nearest.direction());
  };
  if (hint.known && hint.feature_a < a.triangles().size() && hint.feature_b < b.triangles().size()) {
    examine(hint.feature_a, hint.feature_b);
  }
  std::uint32_t i = 0;
  std::uint32_t k = 0;
  while (!nearest.within(enough) && walk.next(i, k)) examine(i, k);
  return nearest.answer(walk.least_left_out());
}

Separation mesh_primitive_separation(const MeshTree& mesh, const ConvexCore& primitive, const Pose& X_MP, double up_to,
                                     double enough, ProximityHint& hint) noexcept {
  Nearest nearest(up_to, mesh.wide().reach());
  BoxWalk walk(mesh.wide(), X_MP, primitive.half, primitive.skin);
  walk.set_limit(up_to);
  ConvexCore triangle;
  triangle.kind = CoreKind::triangle;
  const auto examine = [&](std::uint32_t i) {
    triangle.corners = mesh.triangles()[i];
    const ConvexDistance found = convex_distance(triangle, Pose::Identity(), primitive, X_MP, nearest.distance());
    if (!nearest.offer(found.points, found.certain, {i, 0, true}, hint)) return;
    walk.set_limit(nearest.limit());
    walk.set_direction(nearest.direction());
  };
  if (hint.known && hint.feature_a < mesh.triangles().size()) examine(hint.feature_a);
  std::uint32_t i = 0;
  while (!nearest.within(enough) && walk.next(i)) examine(i);
  return nearest.answer(walk.least_left_out());
}

}  // namespace cellmirror::geometry
