#include "rt_core/geometry/convex/convex_cylinder.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

// Half the square of the distance along a line: first and second derivative.
struct Slope {
  double first;
  double second;
};

Slope slope_along(const CentredCylinder& cylinder, const Vector3d& q, const Vector3d& u) {
  Slope out{0.0, 0.0};
  const double across = std::sqrt(q[0] * q[0] + q[1] * q[1]);
  const double beyond_side = across - cylinder.radius;
  if (beyond_side > 0.0) {
    const double outwards = (q[0] * u[0] + q[1] * u[1]) / across;
    out.first += beyond_side * outwards;
    const double around_squared = std::max(0.0, u[0] * u[0] + u[1] * u[1] - outwards * outwards);
    out.second += outwards * outwards + beyond_side / across * around_squared;
  }
  const double beyond_cap = std::abs(q[2]) - cylinder.half_length;
  if (beyond_cap > 0.0) {
    out.first += std::copysign(beyond_cap, q[2]) * u[2];
    out.second += u[2] * u[2];
  }
  return out;
}

// The parameter in [0, 1] at which p + t u is nearest: Newton's method between bounds that close in on the root.
double nearest_parameter(const CentredCylinder& cylinder, const Vector3d& p, const Vector3d& u) {
  double low = 0.0;
  double high = 1.0;
  Slope slope = slope_along(cylinder, p, u);
  if (!(slope.first < 0.0)) return 0.0;
  if (!(slope_along(cylinder, p + u, u).first > 0.0)) return 1.0;
  double t = 0.5;
  for (int i = 0; i < 100; ++i) {
    slope = slope_along(cylinder, p + t * u, u);
    if (slope.first == 0.0) return t;
    (slope.first < 0.0 ? low : high) = t;
    double next = slope.second > 0.0 ? t - slope.first / slope.second : -1.0;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double step = std::abs(next - t);
    t = next;
    constexpr double kEnough = 1e-14;
    if (step < kEnough || high - low < kEnough) break;
  }
  return t;
}

CoreDistance between(const Vector3d& p_a, const Vector3d& p_b) {
  const Vector3d gap = p_b - p_a;
  return {std::sqrt(dot(gap, gap)), true, false, p_a, p_b};
}

CoreDistance to_edge(const CentredCylinder& cylinder, const Vector3d& from, const Vector3d& edge) {
  const Vector3d q = from + nearest_parameter(cylinder, from, edge) * edge;
  return between(nearest_of(cylinder, q), q);
}

void keep_nearer(const CoreDistance& candidate, CoreDistance& best) {
  if (candidate.distance < best.distance) best = candidate;
}

// A part of a plane with straight borders.
struct Facet {
  const Vector3d* corners;
  std::size_t count;
  Vector3d normal;  // of any length

  [[nodiscard]] bool holds_foot_of(const Vector3d& p) const {
    for (std::size_t i = 0; i < count; ++i) {
      const Vector3d& from = corners[i];
      const Vector3d& to = corners[i + 1 == count ? 0 : i + 1];
      if (dot(cross(to - from, p - from), normal) < 0.0) return false;
    }
    return true;
  }
};

// Where the cylinder's farthest point towards the facet's plane has its foot in the facet, nothing is nearer; where the
// plane cuts the cylinder within the facet they have that point in common. False where neither is so.
bool facet_to_cylinder(const CentredCylinder& cylinder, const Facet& facet, CoreDistance& found) {
  const double nn = dot(facet.normal, facet.normal);
  const double plane = dot(facet.normal, facet.corners[0]);
  const Vector3d top = cylinder.support(facet.normal);
  const Vector3d bottom = cylinder.support(-facet.normal);
  const double over_top = plane - dot(facet.normal, top);
  const double under_bottom = dot(facet.normal, bottom) - plane;
  if (over_top <= 0.0 && under_bottom <= 0.0) {
    const double sum = over_top + under_bottom;
    const Vector3d cut = sum < 0.0 ? Vector3d(top + (over_top / sum) * (bottom - top)) : top;
    if (!facet.holds_foot_of(cut)) return false;
    found = between(cut, cut);
    return true;
  }
  const bool above = over_top > 0.0;
  // An axis along the plane: both ends of the line are equally near.
  Vector3d nearest = above ? top : bottom;
  for (int end = 0; end < 2; ++end) {
    const Vector3d foot = nearest + ((above ? over_top : -under_bottom) / nn) * facet.normal;
    if (facet.holds_foot_of(foot)) {
      found = between(nearest, foot);
      return true;
    }
    if (std::abs(facet.normal[2]) > 1e-12 * std::sqrt(nn)) return false;
    nearest[2] = -nearest[2];
  }
  return false;
}

}  // namespace

Vector3d nearest_of(const CentredCylinder& cylinder, const Vector3d& p) noexcept {
  const double across = std::sqrt(p[0] * p[0] + p[1] * p[1]);
  const double scale = across > cylinder.radius ? cylinder.radius / across : 1.0;
  return {scale * p[0], scale * p[1], std::min(std::max(p[2], -cylinder.half_length), cylinder.half_length)};
}

CoreDistance cylinder_to_point(const CentredCylinder& cylinder, const Vector3d& p) noexcept {
  return between(nearest_of(cylinder, p), p);
}

CoreDistance cylinder_to_segment(const CentredCylinder& cylinder, const Segment& s) noexcept {
  return to_edge(cylinder, s.from, s.to - s.from);
}

CoreDistance cylinder_to_triangle(const CentredCylinder& cylinder, const Triangle& t, double up_to) noexcept {
  // The triangle's nearest point to the centre is a good guess: it may be the answer, or show that all is far away.
  const Vector3d guess = closest_on_triangle(Vector3d::Zero(), t);
  CoreDistance best = cylinder_to_point(cylinder, guess);
  if (best.distance <= 0.0) return best;
  const Vector3d gap = best.p_b - best.p_a;
  const double ahead = std::min({dot(t[0] - best.p_a, gap), dot(t[1] - best.p_a, gap), dot(t[2] - best.p_a, gap)});
  const double squared = dot(gap, gap);
  if (ahead >= squared * (1.0 - 1e-15)) return best;
  if (ahead > up_to * best.distance) {
    best.distance = std::max(up_to, ahead / best.distance);
    best.beyond = true;
    return best;
  }
  const std::array<Vector3d, 3> edges{t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  const Vector3d normal = cross(edges[0], edges[1]);
  constexpr double kFlat = 1e-22;
  if (dot(normal, normal) > kFlat * dot(edges[0], edges[0]) * dot(edges[1], edges[1])) {
    CoreDistance face;
    if (facet_to_cylinder(cylinder, {t.data(), 3, normal}, face)) {
      keep_nearer(face, best);
      return best;
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const CoreDistance edge = to_edge(cylinder, t[i], edges[i]);
    keep_nearer(edge, best);
    // The third corner behind the plane between them: nothing is nearer.
    if (edge.distance <= 0.0 || dot(t[i == 0 ? 2 : i - 1] - edge.p_b, edge.p_b - edge.p_a) >= 0.0) break;
  }
  return best;
}

void refine_cylinder_to_box(const CentredCylinder& cylinder, const Placed<CentredBox>& box,
                            CoreDistance& found) noexcept {
  const Vector3d& half = box.shape.half;
  const std::array<Vector3d, 3> axes{half[0] * box.R.col(0), half[1] * box.R.col(1), half[2] * box.R.col(2)};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d& k = axes[(i + 1) % 3];
    const Vector3d& l = axes[(i + 2) % 3];
    for (const double side : {-1.0, 1.0}) {
      const Vector3d centre = box.t + side * axes[i];
      const std::array<Vector3d, 4> corners{centre - k - l, centre + k - l, centre + k + l, centre - k + l};
      CoreDistance face;
      const Vector3d normal = cross(k, l);
      if (dot(normal, normal) > 0.0 && facet_to_cylinder(cylinder, {corners.data(), 4, normal}, face)) {
        keep_nearer(face, found);
      }
      // The four edges along axis i.
      keep_nearer(to_edge(cylinder, box.t + side * k + l - axes[i], 2.0 * axes[i]), found);
      keep_nearer(to_edge(cylinder, box.t + side * k - l - axes[i], 2.0 * axes[i]), found);
    }
  }
  if (found.distance <= 0.0) found.p_b = found.p_a;
}

namespace {

// The part of a rim near `start` (an angle) that is nearest to the cylinder.
struct Rim {
  Vector3d centre;
  Vector3d x;  // of the length of the radius
  Vector3d y;

  [[nodiscard]] Vector3d at(double angle) const { return centre + std::cos(angle) * x + std::sin(angle) * y; }
  [[nodiscard]] double slope(const CentredCylinder& cylinder, double angle) const {
    const Vector3d q = at(angle);
    return dot(q - nearest_of(cylinder, q), std::cos(angle) * y - std::sin(angle) * x);
  }
};

CoreDistance to_rim(const CentredCylinder& cylinder, const Rim& rim, double start) {
  const double first = rim.slope(cylinder, start);
  double low = start;
  double high = start;
  if (first != 0.0) {
    // Downhill until the slope turns.
    const double direction = first > 0.0 ? -1.0 : 1.0;
    double step = 1e-4;
    double there = start;
    for (int i = 0; i < 20; ++i) {
      there = start + direction * step;
      if (!(rim.slope(cylinder, there) * first > 0.0)) break;
      (direction > 0.0 ? low : high) = there;
      step *= 2.5;
      if (step > 2.0) break;
    }
    (direction > 0.0 ? high : low) = there;
    for (int i = 0; i < 60 && high - low > 1e-15; ++i) {
      const double middle = 0.5 * (low + high);
      (rim.slope(cylinder, middle) > 0.0 ? high : low) = middle;
    }
  }
  const Vector3d q = rim.at(0.5 * (low + high));
  return between(nearest_of(cylinder, q), q);
}

// The rims and caps of `other` against the cylinder.
void rims_and_caps(const CentredCylinder& cylinder, const Placed<CentredCylinder>& other, const Vector3d& near,
                   CoreDistance& best) {
  const Vector3d x = other.shape.radius * other.R.col(0);
  const Vector3d y = other.shape.radius * other.R.col(1);
  const Vector3d axis = other.R.col(2);
  const double start = std::atan2(dot(near - other.t, y), dot(near - other.t, x));
  for (const double side : {-1.0, 1.0}) {
    const Rim rim{other.t + side * other.shape.half_length * axis, x, y};
    keep_nearer(to_rim(cylinder, rim, start), best);
    // The cylinder's farthest point towards the cap, where its foot is in the cap.
    const Vector3d outwards = side * axis;
    const Vector3d nearest = cylinder.support(-outwards);
    const double height = dot(nearest - rim.centre, outwards);
    const Vector3d foot = nearest - height * outwards;
    const Vector3d off = foot - rim.centre;
    if (height >= 0.0 && dot(off, off) <= other.shape.radius * other.shape.radius) {
      keep_nearer(between(nearest, foot), best);
    }
  }
}

// Side to side: the axes' nearest points, where they are not ends.
void sides(const CentredCylinder& cylinder, const Placed<CentredCylinder>& other, CoreDistance& best) {
  const Vector3d along = other.shape.half_length * other.R.col(2);
  const Vector3d own(0.0, 0.0, cylinder.half_length);
  const ClosestPoints axes = segment_segment({-own, own}, {other.t - along, other.t + along});
  if (!(axes.distance > cylinder.radius + other.shape.radius)) return;
  const Vector3d towards = (axes.p_b - axes.p_a) / axes.distance;
  constexpr double kSquare = 1e-9;
  if (std::abs(towards[2]) > kSquare || std::abs(dot(towards, other.R.col(2))) > kSquare) return;
  keep_nearer(between(axes.p_a + cylinder.radius * towards, axes.p_b - other.shape.radius * towards), best);
}

}  // namespace

void refine_cylinder_to_cylinder(const CentredCylinder& cylinder, const Placed<CentredCylinder>& other,
                                 CoreDistance& found) noexcept {
  CoreDistance best = found;
  sides(cylinder, other, best);
  rims_and_caps(cylinder, other, found.p_b, best);
  // The same, seen from the other one.
  const Placed<CentredCylinder> own{cylinder, other.R.transpose(), -(other.R.transpose() * other.t)};
  CoreDistance back = best;
  rims_and_caps(other.shape, own, other.R.transpose() * (found.p_a - other.t), back);
  if (back.distance < best.distance) {
    best.distance = back.distance;
    best.p_a = other.t + other.R * back.p_b;
    best.p_b = other.t + other.R * back.p_a;
  }
  if (best.distance <= 0.0) best.p_b = best.p_a;
  found = best;
}

}  // namespace cellmirror::geometry
