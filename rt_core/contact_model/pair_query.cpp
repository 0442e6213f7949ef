#include "rt_core/contact_model/pair_query.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rt_core/geometry/box_walk.hpp"
#include "rt_core/geometry/inside.hpp"
#include "rt_core/geometry/pair_walk.hpp"

namespace cellmirror::contact_model {

namespace {

using Eigen::Vector3d;
using geometry::ConvexCore;
using geometry::ConvexDistance;
using geometry::CoreKind;

// Cores that are nearer than this have no direction between them.
constexpr double kNoDirection = 1e-7;  // m
// What a plane may cut off from a place that is nearer, m.
constexpr double kSlack = 5e-6;
// How much a hollow rises, compared with how much it turns: an arc has 0.5, a crease 1, a saddle 0.
constexpr double kLeastRise = 0.3;
constexpr double kSameSurface = 1e-7;  // m
// How far a direction may lean towards the cut end of a shaft.
constexpr double kLean = 0.02;
constexpr std::size_t kContactPoints = 4;

// Of a primitive's flat face, in W; false where the direction is not that of one.
bool face_of_primitive(const Piece& piece, const Vector3d& d_in_world, Vector3d& n_W) {
  const Vector3d d = piece.X_WG.linear().transpose() * d_in_world;
  constexpr double kAlong = 1 - 1e-8;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const bool flat = piece.core.kind == CoreKind::box || (piece.core.kind == CoreKind::cylinder && i == 2);
    if (!flat || !(std::abs(d[i]) > kAlong)) continue;
    n_W = d[i] > 0 ? piece.X_WG.linear().col(i) : Vector3d(-piece.X_WG.linear().col(i));
    return true;
  }
  return false;
}

// Whether the nearest point of a piece is one of the whole: not at an end where the shaft continues.
bool nearest_of_whole(const Piece& piece, const Vector3d& p_W, const Vector3d& d_in_world) {
  if (!piece.cut_low && !piece.cut_high) return true;
  const Vector3d axis = piece.X_WG.linear().col(2);
  const double z = axis.dot(p_W - piece.X_WG.translation());
  const double near_end = piece.core.half.z() * (1 - 1e-9) - 1e-9;
  if ((piece.cut_low && z <= -near_end) || (piece.cut_high && z >= near_end))
    return std::abs(axis.dot(d_in_world)) < kLean;
  return true;
}

// Whether the plane of a facet must not count while `place` is what is nearest. Of a hollow both sides count. Over a
// hump the far side does not: its plane would cut off the near one. Nor on a saddle, along which the surface turns
// without rising: there the plane would soon bar a way that is free.
bool is_beyond(const Candidate& plane, const Candidate& place) {
  const double c = place.normal.dot(plane.normal);
  if (plane.gap < place.gap * c - kSlack) return true;
  const Vector3d back = place.surface - plane.surface;
  const double sine = std::sqrt(std::max(0.0, 1 - c * c));
  return plane.normal.dot(back) < kLeastRise * sine * back.norm() + kSameSurface;
}

}  // namespace

PairQuery::PairQuery(double margin) : margin_(margin) {
  for (auto* list : {&near_, &only_reference_, &planes_, &refused_}) list->reserve(kMost);
}

QueryResult PairQuery::ask(const Piece& instrument, const Piece& obstacle, double reach, bool with_overlap,
                           std::vector<Candidate>& out) {
  for (auto* list : {&near_, &only_reference_, &planes_, &refused_}) list->clear();
  reach_ = reach;
  X_OW_ = obstacle.X_WG.inverse(Eigen::Isometry);
  X_IW_ = instrument.X_WG.inverse(Eigen::Isometry);
  crowded_ = overlapped_ = perhaps_inside_ = false;
  certain_ = true;
  nearest_ = std::numeric_limits<double>::infinity();
  if (instrument.mesh() && obstacle.mesh()) {
    mesh_near_mesh(instrument, obstacle);
  } else if (instrument.mesh() || obstacle.mesh()) {
    mesh_near_primitive(instrument, obstacle);
  } else {
    primitive_near_primitive(instrument, obstacle);
  }
  if (crowded_) return QueryResult::crowded;
  if (!overlapped_) overlapped_ = one_in_the_other(instrument, obstacle);
  if (!overlapped_) {
    keep_what_fits(out);
  } else if (with_overlap) {
    overlap(instrument, obstacle, out);
  }
  return certain_ ? QueryResult::done : QueryResult::uncertain;
}

void PairQuery::primitive_near_primitive(const Piece& instrument, const Piece& obstacle) {
  const ConvexDistance found = convex_distance(instrument.core, instrument.X_WG, obstacle.core, obstacle.X_WG);
  certain_ = found.certain;
  consider(instrument, obstacle, {found.points.p_a, found.points.p_b});
}

void PairQuery::mesh_near_primitive(const Piece& instrument, const Piece& obstacle) {
  const bool by_instrument = instrument.mesh();
  const Piece& mesh = by_instrument ? instrument : obstacle;
  const Piece& primitive = by_instrument ? obstacle : instrument;
  const geometry::MeshTree& tree = *mesh.solid->tree;
  const Pose X_MP = (by_instrument ? X_IW_ : X_OW_) * primitive.X_WG;
  const double limit = reach_ + primitive.skin;
  geometry::BoxWalk walk(tree.wide(), X_MP, primitive.core.half, 0.0);
  walk.set_limit(limit);
  ConvexCore triangle;
  triangle.kind = CoreKind::triangle;
  std::uint32_t i = 0;
  while (!crowded_ && !overlapped_ && walk.next(i)) {
    triangle.corners = tree.triangles()[i];
    const ConvexDistance found = convex_distance(triangle, Pose::Identity(), primitive.core, X_MP, limit);
    if (!(found.points.distance < limit)) continue;
    certain_ = certain_ && found.certain;
    const Vector3d on_mesh = mesh.X_WG * found.points.p_a;
    const Vector3d on_primitive = mesh.X_WG * found.points.p_b;
    consider(instrument, obstacle,
             by_instrument ? Touch{on_mesh, on_primitive, i, kNone} : Touch{on_primitive, on_mesh, kNone, i});
  }
}

void PairQuery::mesh_near_mesh(const Piece& instrument, const Piece& obstacle) {
  const geometry::MeshTree& a = *instrument.solid->tree;
  const geometry::MeshTree& b = *obstacle.solid->tree;
  const Pose X_AB = X_IW_ * obstacle.X_WG;
  geometry::PairWalk walk(a.wide(), b.wide(), X_AB);
  walk.set_limit(reach_);
  std::uint32_t i = 0;
  std::uint32_t k = 0;
  while (!crowded_ && !overlapped_ && walk.next(i, k)) {
    const geometry::Triangle& t = b.triangles()[k];
    const geometry::ClosestPoints points =
        geometry::triangle_triangle(a.triangles()[i], {X_AB * t[0], X_AB * t[1], X_AB * t[2]}, reach_);
    if (!(points.distance < reach_)) continue;
    consider(instrument, obstacle, {instrument.X_WG * points.p_a, instrument.X_WG * points.p_b, i, k});
  }
}

void PairQuery::consider(const Piece& instrument, const Piece& obstacle, const Touch& touch) {
  const Vector3d between = touch.p_I - touch.p_O;
  const double distance = between.norm();
  const double skins = instrument.skin + obstacle.skin;
  if (!(distance - skins < reach_)) return;
  if (!(distance > kNoDirection)) {
    overlapped_ = true;
    return;
  }
  const Vector3d d = between / distance;
  const ObstaclePlace place = query_obstacle(obstacle, touch, d, distance);
  if (place.behind) return;
  const bool nearest_i = nearest_on_instrument(instrument, touch, d);
  Candidate found;
  found.node = instrument.node;
  found.distance = distance - skins;
  found.normal = place.normal;
  found.point = touch.p_I - instrument.skin * place.normal;
  found.surface = touch.p_O;
  if (place.nearest) {
    found.gap = found.distance - margin_;
    push(nearest_i || place.face ? near_ : only_reference_, found);
    if (place.face && !instrument.mesh()) add_ends(instrument, obstacle, touch, found);
  } else if (const double height = place.normal.dot(between); height > 0) {
    found.gap = height - skins - margin_;
    push(planes_, found);
  }
}

PairQuery::ObstaclePlace PairQuery::query_obstacle(const Piece& obstacle, const Touch& touch, const Vector3d& d,
                                                   double distance) {
  ObstaclePlace out;
  out.normal = d;
  out.nearest = true;
  if (!obstacle.mesh()) {
    out.face = face_of_primitive(obstacle, d, out.normal);
    return out;
  }
  const MeshSurface& surface = *obstacle.surface;
  const bool closed = obstacle.solid->tree->mesh().closed;
  const Eigen::Matrix3d& R = obstacle.X_WG.linear();
  const Vector3d p_M = X_OW_ * touch.p_O;
  const Vector3d d_in_mesh = X_OW_.linear() * d;
  const Feature feature = surface.feature(touch.triangle_O, p_M);
  const double facing = surface.facet_normal(touch.triangle_O).dot(d_in_mesh);
  if (distance < nearest_) {
    nearest_ = distance;
    perhaps_inside_ = closed && facing < 0;
    nearest_point_ = touch.p_I;
  }
  out.nearest = surface.nearest_around(feature, p_M, d_in_mesh);
  out.face = feature.kind == FeatureKind::face;
  out.behind = closed && facing <= 0 && (out.face || !out.nearest);
  // An open mesh has two sides.
  const double side = !closed && facing < 0 ? -1.0 : 1.0;
  Vector3d smooth;
  if (surface.smooth_normal(feature, smooth) && side * smooth.dot(d_in_mesh) > 0) {
    out.normal = side * (R * smooth);
  } else if (!out.nearest || out.face) {
    out.normal = side * (R * surface.facet_normal(touch.triangle_O));
  }
  return out;
}

bool PairQuery::nearest_on_instrument(const Piece& instrument, const Touch& touch, const Vector3d& d) {
  if (!instrument.mesh()) return nearest_of_whole(instrument, touch.p_I, d);
  const Vector3d p_M = X_IW_ * touch.p_I;
  const Vector3d back_in_mesh = -(X_IW_.linear() * d);
  const Feature feature = instrument.surface->feature(touch.triangle_I, p_M);
  const double facing = instrument.surface->facet_normal(touch.triangle_I).dot(back_in_mesh);
  if (touch.triangle_O == kNone && d.dot(touch.p_I - touch.p_O) < nearest_) {
    nearest_ = d.dot(touch.p_I - touch.p_O);
    perhaps_inside_ = instrument.solid->tree->mesh().closed && facing < 0;
    nearest_point_ = touch.p_O;
  }
  return instrument.surface->nearest_around(feature, p_M, back_in_mesh);
}

// Where a shaft lies along a face, both ends are in contact; which point between them is the nearest is rounding.
void PairQuery::add_ends(const Piece& instrument, const Piece& obstacle, const Touch& touch, const Candidate& found) {
  if (instrument.core.kind != CoreKind::segment && instrument.core.kind != CoreKind::cylinder) return;
  const Vector3d axis = instrument.X_WG.linear().col(2);
  const Vector3d& n = found.normal;
  Vector3d across = n - n.dot(axis) * axis;
  across = across.norm() > 1e-6 ? Vector3d(instrument.core.half.x() * across.normalized()) : Vector3d::Zero();
  for (const double side : {-1.0, 1.0}) {
    const Vector3d p = instrument.X_WG.translation() + side * instrument.core.half.z() * axis - across;
    if (!over_face(obstacle, touch.triangle_O, p)) continue;
    Candidate end = found;
    end.point = p - instrument.skin * n;
    end.distance = n.dot(p - touch.p_O) - instrument.skin - obstacle.skin;
    end.gap = end.distance - margin_;
    if (end.distance < reach_ && (end.point - found.point).norm() > 1e-9) push(near_, end);
  }
}

bool PairQuery::over_face(const Piece& obstacle, std::uint32_t triangle, const Vector3d& p_W) const {
  const Vector3d p = X_OW_ * p_W;
  if (obstacle.mesh()) {
    // A smooth surface bends away between the ends; only where it is flat do they bear.
    const Feature feature = obstacle.surface->feature(triangle, p);
    Vector3d smooth;
    return feature.kind == FeatureKind::face && obstacle.surface->smooth_normal(feature, smooth) &&
           smooth == obstacle.surface->facet_normal(triangle);
  }
  if (obstacle.core.kind == CoreKind::cylinder) return std::hypot(p.x(), p.y()) <= obstacle.core.half.x();
  int outside = 0;
  for (Eigen::Index i = 0; i < 3; ++i) outside += std::abs(p[i]) > obstacle.core.half[i] ? 1 : 0;
  return outside <= 1;
}

bool PairQuery::one_in_the_other(const Piece& instrument, const Piece& obstacle) const {
  const auto holds = [](const Piece& mesh, const Vector3d& p_W) {
    return geometry::contains(*mesh.solid->tree, mesh.X_WG.inverse(Eigen::Isometry) * p_W);
  };
  const bool found = std::isfinite(nearest_);
  if (found && perhaps_inside_) return holds(obstacle.mesh() ? obstacle : instrument, nearest_point_);
  if (found) return false;
  // So deep inside that no surface is within reach.
  return (obstacle.mesh() && holds(obstacle, instrument.X_WG.translation())) ||
         (instrument.mesh() && holds(instrument, obstacle.X_WG.translation()));
}

void PairQuery::keep_what_fits(std::vector<Candidate>& out) {
  out.insert(out.end(), near_.begin(), near_.end());
  for (const Candidate& plane : planes_) {
    const auto cuts_off = [&plane](const Candidate& place) { return is_beyond(plane, place); };
    const bool refuse = std::ranges::any_of(near_, cuts_off) || std::ranges::any_of(only_reference_, cuts_off);
    refuse ? refused_.push_back(plane) : out.push_back(plane);
  }
}

void PairQuery::overlap(const Piece& instrument, const Piece& obstacle, std::vector<Candidate>& out) {
  if (!geometry::contact(*instrument.solid, instrument.X_WS, *obstacle.solid, obstacle.X_WS, kContactPoints,
                         contact_)) {
    certain_ = false;
    return;
  }
  for (const geometry::ContactPoint& point : contact_.points) {
    Candidate found;
    found.normal = -point.normal;
    found.point = point.p_W;
    found.gap = -point.depth - margin_;
    found.distance = -point.depth;
    found.node = instrument.node;
    out.push_back(found);
  }
}

void PairQuery::push(std::vector<Candidate>& list, const Candidate& candidate) {
  if (list.size() < kMost) {
    list.push_back(candidate);
  } else {
    crowded_ = true;
  }
}

}  // namespace cellmirror::contact_model
