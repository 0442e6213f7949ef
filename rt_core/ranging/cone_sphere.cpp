// Along a beam u from the apex a sphere about c is met at s = u . c -+ sqrt((u . c)^2 - |c|^2 + r^2), under the
// incidence whose cosine is that root by r. From outside the nearer point counts; it gets nearer and its incidence
// smaller as u . c grows. Inside there is only the farther one, and it gets nearer as u . c falls, while the incidence
// grows where u . c is positive: there the limit of the incidence may be what stops it.
#include <algorithm>
#include <array>
#include <cmath>

#include "rt_core/ranging/cone_curved.hpp"
#include "rt_core/ranging/cone_sphere.hpp"

namespace cellmirror::ranging {

namespace {

using Eigen::Vector3d;

struct Direction {
  Vector3d u;
  double along;  // u . c
};

Direction towards(const Vector3d& u, const Vector3d& c) { return {u, u.dot(c)}; }

// The direction in the cone that is nearest to v, of any length. Any where v is zero or points backward.
Vector3d nearest_direction(const ConeShape& cone, const Vector3d& v) {
  // Made about 1 long before it is squared: squares and products of numbers that are nearly too small have lost their
  // digits.
  const double size = v.cwiseAbs().maxCoeff();
  const Vector3d u = size > 0.0 ? Vector3d((v / size).normalized()) : v;
  if (size > 0.0 && u.z() >= cone.cosine) return u;
  const double across = v.head<2>().cwiseAbs().maxCoeff();
  if (!(across > 0.0)) return {cone.sine, 0.0, cone.cosine};
  const Eigen::Vector2d side = (v.head<2>() / across).normalized();
  return {cone.sine * side.x(), cone.sine * side.y(), cone.cosine};
}

// Points on the beams with u . c == along: a circle of directions about c, of which as few are tried as show whether
// any is in the cone and beyond the seam. The parts of the circle that either allows are arcs: if two arcs meet, the
// middle or an end of one lies in the other.
template <typename Try>
void try_circle(const ConeShape& cone, const Vector3d& c, double along, double distance, const Seam& seam,
                const Try& offer) {
  const double length = c.norm();
  const Vector3d axis = c / length;
  const double cosine = along / length;
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const Vector3d f1 = axis.unitOrthogonal();
  const Vector3d f2 = axis.cross(f1);
  // The arc on which direction . u >= bound.
  struct Arc {
    double middle;
    double half;
  };
  const auto arc_of = [&](const Vector3d& direction, double bound) {
    const double x = direction.dot(f1);
    const double y = direction.dot(f2);
    const double swing = sine * std::hypot(x, y);
    const double rest = bound - cosine * direction.dot(axis);
    const double ratio = swing > 0.0 ? rest / swing : (rest <= 0.0 ? -1.0 : 1.0);
    return Arc{std::atan2(y, x), std::acos(std::clamp(ratio, -1.0, 1.0))};
  };
  const auto try_at = [&](double angle) {
    offer(Vector3d(cosine * axis + sine * (std::cos(angle) * f1 + std::sin(angle) * f2)));
  };
  constexpr double kInside = 1.0 - 1e-9;
  std::array<Arc, 2> arcs{arc_of(Vector3d::UnitZ(), cone.cosine), {}};
  std::size_t count = 1;
  if (seam.there) arcs[count++] = arc_of(seam.outward, seam.outward.dot(c) / distance);
  for (std::size_t i = 0; i < count; ++i) {
    try_at(arcs[i].middle);
    if (count == 1) break;
    try_at(arcs[i].middle - kInside * arcs[i].half);
    try_at(arcs[i].middle + kInside * arcs[i].half);
  }
}

}  // namespace

void nearest_on_sphere_from_outside(const ConeShape& cone, const Vector3d& c, double r, const Seam& seam,
                                    Nearest& best) {
  const Direction beam = towards(nearest_direction(cone, c), c);
  const double gap = c.squaredNorm() - r * r;
  const double root = beam.along * beam.along - gap;
  if (!(beam.along > 0.0) || !(root >= 0.0)) return;
  const double square = std::sqrt(root);
  constexpr double kRounding = 1e-12;
  if (square < (cone.cos_incidence - kRounding) * r && gap > 0.0) return;
  const double s = std::max(gap, 0.0) / (beam.along + square);
  const Vector3d p = s * beam.u;
  if (seam.keeps(p - c)) best.offer(s, p);
}

void nearest_on_sphere_from_inside(const ConeShape& cone, const Vector3d& c, double r, const Seam& seam,
                                   Nearest& best) {
  const double depth = r * r - c.squaredNorm();
  const auto far_root = [&](double along) { return along + std::sqrt(std::max(0.0, along * along + depth)); };
  const auto offer = [&](const Vector3d& u) {
    const double along = u.dot(c);
    const double root = along * along + depth;
    constexpr double kRounding = 1e-12;
    const double least = (cone.cos_incidence - kRounding) * r;
    if (!(root >= 0.0) || (least > 0.0 && root < least * least)) return;
    const double s = far_root(along);
    const Vector3d p = s * u;
    if (s >= 0.0 && cone.holds(p) && seam.keeps(p - c)) best.offer(s, p);
  };
  offer(nearest_direction(cone, -c));
  if (!(cone.cos_incidence > 0.0)) return;
  const double squared = cone.cos_incidence * cone.cos_incidence * r * r - depth;
  if (!(squared > 0.0) || !(squared <= c.squaredNorm())) return;
  const double along = std::sqrt(squared);
  try_circle(cone, c, along, far_root(along), seam, offer);
}

void nearest_on_sphere(const ConeShape& cone, const Vector3d& centre, double radius, Nearest& best) {
  constexpr double kTouching = 1e-14;
  const double distance = std::abs(centre.norm() - radius);
  if (distance <= kTouching * radius) best.offer(distance, Vector3d::Zero());
  if (!(distance < best.distance)) return;
  if (centre.squaredNorm() < radius * radius) {
    nearest_on_sphere_from_inside(cone, centre, radius, Seam{}, best);
  } else {
    nearest_on_sphere_from_outside(cone, centre, radius, Seam{}, best);
  }
}

}  // namespace cellmirror::ranging
