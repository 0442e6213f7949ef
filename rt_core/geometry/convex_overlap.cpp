#include "rt_core/geometry/convex_overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

Vector3d unit(const Vector3d& v) { return v / std::sqrt(dot(v, v)); }

// Any unit vector across `v`.
Vector3d across(const Vector3d& v) {
  Eigen::Index least = 0;
  v.cwiseAbs().minCoeff(&least);
  return unit(cross(v, Vector3d::Unit(least)));
}

// A body with the directions of its edges and of its faces' normals, as far as they are straight and flat.
struct Core {
  ConvexCore core;
  FewPoints few;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Vector3d t = Vector3d::Zero();
  std::array<Vector3d, 3> edges;  // unit vectors; a cylinder's axis counts as an edge
  std::array<Vector3d, 3> normals;
  std::size_t edge_count = 0;
  std::size_t normal_count = 0;
  bool round = false;

  void add_edge(const Vector3d& along) {
    const double squared = dot(along, along);
    if (squared > 0.0) edges[edge_count++] = along / std::sqrt(squared);
  }
  void describe() {
    if (core.kind == CoreKind::box) {
      for (Eigen::Index i = 0; i < 3; ++i) {
        add_edge(R.col(i));
        normals[normal_count++] = R.col(i);
      }
    } else if (core.kind == CoreKind::cylinder) {
      round = true;
      add_edge(R.col(2));
      normals[normal_count++] = R.col(2);
    } else {
      if (few.count > 1) add_edge(few.points[1] - few.points[0]);
      if (few.count < 3) return;
      add_edge(few.points[2] - few.points[1]);
      add_edge(few.points[0] - few.points[2]);
      const Vector3d normal = cross(few.points[1] - few.points[0], few.points[2] - few.points[0]);
      if (dot(normal, normal) > 0.0) normals[normal_count++] = unit(normal);
    }
  }
  [[nodiscard]] Vector3d support(const Vector3d& direction) const {
    switch (core.kind) {
      case CoreKind::box:
        return Placed<CentredBox>{{core.half}, R, t}.support(direction);
      case CoreKind::cylinder:
        return Placed<CentredCylinder>{{core.half[0], core.half[2]}, R, t}.support(direction);
      default:
        return few.support(direction);
    }
  }
};

// Looks for the direction in which the overlap is least. Every direction that is tried gives a depth that parts the
// bodies; what remains is to try the right ones.
class Search {
 public:
  Search(const Core& a, const Core& b) : a_(a), b_(b) { best_.depth = std::numeric_limits<double>::infinity(); }

  [[nodiscard]] const LeastOverlap& best() const { return best_; }
  [[nodiscard]] Vector3d difference(const Vector3d& n) const { return a_.support(n) - b_.support(-n); }
  [[nodiscard]] double overlap(const Vector3d& n) const { return dot(difference(n), n); }

  void consider(const Vector3d& n) {
    const double depth = overlap(n);
    if (!(depth < best_.depth)) return;
    best_.depth = depth;
    best_.normal = n;
  }
  void consider_line(const Vector3d& n) {
    consider(n);
    consider(-n);
  }

  void consider_flat_faces() {
    for (const Core* core : {&a_, &b_}) {
      for (std::size_t i = 0; i < core->normal_count; ++i) consider_line(core->normals[i]);
    }
  }
  // Faces that an edge of each spans. Then those of points and of edges that are parallel, whose difference is flat.
  void consider_spanned_faces() {
    for (std::size_t i = 0; i < a_.edge_count; ++i) {
      for (std::size_t k = 0; k < b_.edge_count; ++k) {
        const Vector3d n = cross(a_.edges[i], b_.edges[k]);
        constexpr double kParallel = 1e-20;  // square of the sine
        if (dot(n, n) > kParallel) consider_line(unit(n));
      }
    }
    for (const Core* core : {&a_, &b_}) {
      for (std::size_t i = 0; i < core->edge_count; ++i) {
        const Vector3d n = across(core->edges[i]);
        consider_line(n);
        consider_line(cross(core->edges[i], n));
      }
    }
    for (Eigen::Index i = 0; i < 3; ++i) consider_line(Vector3d::Unit(i));
  }

  // Along all normals that are square to a straight edge: there lie the surfaces that a rim sweeps along that edge.
  void consider_circle(const Vector3d& edge);
  // In all directions: where two rims meet.
  void consider_sphere();

 private:
  void refine_on_circle(const Vector3d& x, const Vector3d& y, double from, double to);
  void refine_on_sphere(Vector3d n);

  const Core& a_;
  const Core& b_;
  LeastOverlap best_;
};

void Search::refine_on_circle(const Vector3d& x, const Vector3d& y, double from, double to) {
  const double golden = 2.0 - std::numbers::phi;
  const auto at = [&](double angle) { return Vector3d(std::cos(angle) * x + std::sin(angle) * y); };
  double left = from + golden * (to - from);
  double right = to - golden * (to - from);
  double at_left = overlap(at(left));
  double at_right = overlap(at(right));
  for (int i = 0; i < 40; ++i) {
    if (at_left < at_right) {
      to = right;
      right = left;
      at_right = at_left;
      left = from + golden * (to - from);
      at_left = overlap(at(left));
    } else {
      from = left;
      left = right;
      at_left = at_right;
      right = to - golden * (to - from);
      at_right = overlap(at(right));
    }
  }
  consider(at(0.5 * (from + to)));
}

void Search::consider_circle(const Vector3d& edge) {
  constexpr std::size_t kSteps = 48;
  constexpr double kStep = 2.0 * std::numbers::pi / kSteps;
  const Vector3d x = across(edge);
  const Vector3d y = cross(edge, x);
  std::array<double, kSteps> depths{};
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double angle = kStep * static_cast<double>(i);
    depths[i] = overlap(std::cos(angle) * x + std::sin(angle) * y);
  }
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double before = depths[i == 0 ? kSteps - 1 : i - 1];
    const double after = depths[i + 1 == kSteps ? 0 : i + 1];
    if (depths[i] > before || depths[i] > after) continue;
    const double angle = kStep * static_cast<double>(i);
    refine_on_circle(x, y, angle - kStep, angle + kStep);
  }
}

// How fast the support point of a cylinder turns with the normal: the second derivative of radius * |n across the
// axis|.
struct RimCurvature {
  Vector3d along;  // unit vector along the rim
  double radius;   // divided by the part of the normal that is across the axis; 0 where the normal is the axis

  RimCurvature(const Core& cylinder, const Vector3d& n) {
    along = cross(cylinder.R.col(2), n);
    const double part = std::sqrt(dot(along, along));
    radius = part > 0.0 ? cylinder.core.half[0] / part : 0.0;
    if (part > 0.0) along /= part;
  }
};

// Newton's method on the sphere, for two cylinders. The gradient of a support function is the support point.
void Search::refine_on_sphere(Vector3d n) {
  double depth = overlap(n);
  for (int i = 0; i < 60; ++i) {
    const Vector3d point = difference(n);
    const Vector3d x = across(n);
    const Vector3d y = cross(n, x);
    const Eigen::Vector2d slope(dot(point, x), dot(point, y));
    const RimCurvature rim_a(a_, n);
    const RimCurvature rim_b(b_, n);
    const Eigen::Vector2d along_a(dot(rim_a.along, x), dot(rim_a.along, y));
    const Eigen::Vector2d along_b(dot(rim_b.along, x), dot(rim_b.along, y));
    const double xx = rim_a.radius * along_a[0] * along_a[0] + rim_b.radius * along_b[0] * along_b[0] - depth;
    const double xy = rim_a.radius * along_a[0] * along_a[1] + rim_b.radius * along_b[0] * along_b[1];
    const double yy = rim_a.radius * along_a[1] * along_a[1] + rim_b.radius * along_b[1] * along_b[1] - depth;
    const double determinant = xx * yy - xy * xy;
    constexpr double kMaxStep = 0.2;  // rad
    Eigen::Vector2d step(xy * slope[1] - yy * slope[0], xy * slope[0] - xx * slope[1]);
    if (xx > 0.0 && determinant > 0.0) {
      step /= determinant;
    } else {
      step = -slope;  // a saddle or a hill: down
    }
    const double length = step.norm();
    if (!(length > 0.0)) break;
    if (length > kMaxStep) step *= kMaxStep / length;
    bool lower = false;
    for (int halving = 0; halving < 30 && !lower; ++halving) {
      const Vector3d next = unit(n + step[0] * x + step[1] * y);
      const double there = overlap(next);
      lower = there < depth;
      if (lower) {
        depth = there;
        n = next;
      }
      step *= 0.5;
    }
    if (!lower) break;
  }
  consider(n);
}

void Search::consider_sphere() {
  // Directions spread evenly over the sphere (Fibonacci).
  constexpr std::size_t kDirections = 96;
  constexpr std::size_t kRefined = 6;
  std::array<LeastOverlap, kRefined> starts;
  for (LeastOverlap& start : starts) start.depth = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < kDirections; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / kDirections;
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / std::numbers::phi;
    const double r = std::sqrt(1.0 - z * z);
    const Vector3d n(r * std::cos(angle), r * std::sin(angle), z);
    LeastOverlap start{overlap(n), n};
    for (LeastOverlap& kept : starts) {
      if (start.depth < kept.depth) std::swap(start, kept);
    }
  }
  const Vector3d line = b_.t - a_.t;
  if (dot(line, line) > 0.0) refine_on_sphere(unit(line));
  for (const LeastOverlap& start : starts) {
    if (std::isfinite(start.depth)) refine_on_sphere(start.normal);
  }
}

}  // namespace

LeastOverlap least_overlap(const ConvexCore& a, const ConvexCore& b, const RelativePose& X_AB) noexcept {
  Core own;
  own.core = a;
  Core other;
  other.core = b;
  other.R = X_AB.R;
  other.t = X_AB.t;
  if (has_few_points(a)) own.few = few_points(a);
  if (has_few_points(b)) other.few = few_points(b, X_AB);
  own.describe();
  other.describe();
  Search search(own, other);
  search.consider_flat_faces();
  search.consider_spanned_faces();
  if (own.round || other.round) {
    for (const Core* core : {&own, &other}) {
      for (std::size_t i = 0; i < core->edge_count; ++i) search.consider_circle(core->edges[i]);
    }
    if (own.round && other.round) search.consider_sphere();
  }
  LeastOverlap best = search.best();
  best.depth = std::max(best.depth, 0.0);
  return best;
}

}  // namespace cellmirror::geometry
