#include "rt_core/geometry/convex/convex_overlap.hpp"

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

// Searches the direction of least overlap. Every tested direction gives a depth that separates the bodies.
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

  // Along all normals that are square to a straight edge: the surfaces swept by a rim along that edge are there.
  void consider_circle(const Vector3d& edge);
  // In all directions: where two rims meet.
  void consider_sphere();

 private:
  struct Circle {
    Vector3d x;
    Vector3d y;
  };
  struct CirclePoint {
    double angle = 0;  // from x to y
    double depth = 0;
    double slope = 0;  // of the depth over the angle
  };
  // Considers it, too.
  CirclePoint on_circle(const Circle& circle, double angle);
  CirclePoint on_circle(const Circle& circle, double angle, double cosine, double sine);
  void refine_on_circle(const Circle& circle, CirclePoint from, CirclePoint to);
  void refine_on_sphere(Vector3d n);

  const Core& a_;
  const Core& b_;
  LeastOverlap best_;
};

// Between two angles at which the overlap falls and rises: where its slope passes 0, by false position with halved
// weights (Illinois). Kinks are faces that were considered by themselves.
void Search::refine_on_circle(const Circle& circle, CirclePoint from, CirclePoint to) {
  constexpr double kEnough = 1e-8;  // rad: smooth minima are then right to the square of it
  double weight_from = from.slope;
  double weight_to = to.slope;
  for (int i = 0; i < 40 && to.angle - from.angle > kEnough; ++i) {
    const double sum = weight_to - weight_from;
    double angle = sum > 0.0 ? (from.angle * weight_to - to.angle * weight_from) / sum : 0.0;
    const double least_step = 0.01 * (to.angle - from.angle);
    angle = std::min(std::max(angle, from.angle + least_step), to.angle - least_step);
    const CirclePoint middle = on_circle(circle, angle);
    if (middle.slope < 0.0) {
      from = middle;
      weight_from = middle.slope;
      weight_to *= 0.5;
    } else {
      to = middle;
      weight_to = middle.slope;
      weight_from *= 0.5;
    }
  }
}

Search::CirclePoint Search::on_circle(const Circle& circle, double angle) {
  return on_circle(circle, angle, std::cos(angle), std::sin(angle));
}

Search::CirclePoint Search::on_circle(const Circle& circle, double angle, double cosine, double sine) {
  const Vector3d n = cosine * circle.x + sine * circle.y;
  const Vector3d along = cosine * circle.y - sine * circle.x;
  const Vector3d point = difference(n);
  const CirclePoint out{angle, dot(point, n), dot(point, along)};
  if (out.depth < best_.depth) best_ = {out.depth, n};
  return out;
}

void Search::consider_circle(const Vector3d& edge) {
  constexpr std::size_t kSteps = 32;
  constexpr double kStep = 2.0 * std::numbers::pi / kSteps;
  Circle circle;
  circle.x = across(edge);
  circle.y = cross(edge, circle.x);
  std::array<CirclePoint, kSteps + 1> points;
  const double cosine_step = std::cos(kStep);
  const double sine_step = std::sin(kStep);
  double cosine = 1.0;
  double sine = 0.0;
  for (std::size_t i = 0; i < kSteps; ++i) {
    points[i] = on_circle(circle, kStep * static_cast<double>(i), cosine, sine);
    const double next = cosine * cosine_step - sine * sine_step;
    sine = sine * cosine_step + cosine * sine_step;
    cosine = next;
  }
  points[kSteps] = points[0];
  points[kSteps].angle = 2.0 * std::numbers::pi;
  for (std::size_t i = 0; i < kSteps; ++i) {
    const CirclePoint& from = points[i];
    const CirclePoint& to = points[i + 1];
    if (!(from.slope < 0.0 && to.slope > 0.0)) continue;
    // A support function is at least what any of its points makes of the direction: can it be less than the best?
    const double beyond_from = from.depth * cosine_step + from.slope * sine_step;
    const double beyond_to = to.depth * cosine_step - to.slope * sine_step;
    if (std::max(beyond_from, beyond_to) < best_.depth) refine_on_circle(circle, from, to);
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
  for (int i = 0; i < 30; ++i) {
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
    constexpr double kEnough = 1e-9;  // rad
    if (!(length > kEnough)) break;
    if (length > kMaxStep) step *= kMaxStep / length;
    bool lower = false;
    for (int halving = 0; halving < 12 && !lower; ++halving) {
      const Vector3d next = unit(n + step[0] * x + step[1] * y);
      const double there = overlap(next);
      lower = there < depth * (1.0 - 1e-12);
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
    const Vector3d point = difference(n);
    LeastOverlap start{dot(point, n), n};
    // Near it the overlap is at least what this point makes of it: can it be less than the best?
    constexpr double kNear = 0.3;  // rad: half the greatest gap between directions, and some more
    const double slope = std::sqrt(std::max(0.0, dot(point, point) - start.depth * start.depth));
    if (start.depth * std::cos(kNear) - slope * std::sin(kNear) >= best_.depth) continue;
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
