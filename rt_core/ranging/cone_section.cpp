#include "rt_core/ranging/cone_section.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>

namespace cellmirror::ranging {

namespace {

using Eigen::Vector3d;

// Where a line p0 + t D crosses the double cone: the roots of a t^2 + 2 b t + c.
struct Crossings {
  std::array<double, 2> t{};
  int count = 0;
};

Crossings crossings(const ConeShape& cone, const Vector3d& p0, const Vector3d& D) {
  const double ss = cone.sine * cone.sine;
  const double cc = cone.cosine * cone.cosine;
  const double a = ss * D.z() * D.z() - cc * (D.x() * D.x() + D.y() * D.y());
  const double b = ss * p0.z() * D.z() - cc * (p0.x() * D.x() + p0.y() * D.y());
  const double c = ss * p0.z() * p0.z() - cc * (p0.x() * p0.x() + p0.y() * p0.y());
  double discriminant = b * b - a * c;
  const double touching = ConeShape::kSlack * (b * b + std::abs(a * c));
  if (discriminant < -touching) return {};
  discriminant = std::max(discriminant, 0.0);
  // Of the two ways to write a root the one that does not subtract like numbers.
  const double s = -(b + std::copysign(std::sqrt(discriminant), b));
  Crossings out;
  if (a != 0.0) out.t[static_cast<std::size_t>(out.count++)] = s / a;
  if (s != 0.0) out.t[static_cast<std::size_t>(out.count++)] = c / s;
  return out;
}

// A polygon without area: its edges, each with the incidence on a line.
void nearest_on_edges(const ConeShape& cone, std::span<const Vector3d> corners, Nearest& best) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3d& from = corners[i];
    const Vector3d& to = corners[(i + 1) % corners.size()];
    const Vector3d D = to - from;
    const double length = D.norm();
    const double d = length > 0.0 ? from.cross(D).norm() / length : from.norm();
    Vector3d p;
    if (nearest_on_segment(cone, from, to, cone.reach(d, best.distance), p)) best.offer(p.norm(), p);
  }
}

// `area`: the normal times the area of the parallelogram of the edges at the first corner. False: there is no telling.
bool normal_of(std::span<const Vector3d> corners, Vector3d& area, Vector3d& normal) {
  const Vector3d first = corners[1] - corners[0];
  const Vector3d last = corners[corners.size() - 1] - corners[0];
  area = first.cross(last);
  const double size = area.norm();
  const double sine = size / std::sqrt(first.squaredNorm() * last.squaredNorm());
  constexpr double kFlat = 1e-12;
  if (!(sine > kFlat)) return false;
  normal = area / size;
  // What rounding left of the product of nearly parallel edges must not tilt a long needle along itself.
  constexpr double kNeedle = 1e-3;
  if (sine < kNeedle) {
    const Vector3d& longer = first.squaredNorm() > last.squaredNorm() ? first : last;
    normal = (normal - normal.dot(longer) / longer.squaredNorm() * longer).normalized();
  }
  return true;
}

}  // namespace

bool nearest_on_plane(const ConeShape& cone, const Vector3d& normal, double d, Vector3d& q) {
  if (normal.z() >= cone.cosine) {
    q = d * normal;
    return true;
  }
  // The direction within the cone that is nearest to the normal.
  const double across = std::sqrt(normal.x() * normal.x() + normal.y() * normal.y());
  if (!(across > 0.0)) return false;  // the plane is behind
  const Vector3d u(cone.sine * (normal.x() / across), cone.sine * (normal.y() / across), cone.cosine);
  const double towards = cone.sine * across + cone.cosine * normal.z();
  if (!(towards > 0.0)) return false;
  q = d / towards * u;
  return true;
}

bool nearest_on_segment(const ConeShape& cone, const Vector3d& a, const Vector3d& b, double limit, Vector3d& p) {
  const Vector3d D = b - a;
  const double squared_length = D.squaredNorm();
  const double squared_limit = limit * limit;
  constexpr double kPoint = 1e-200;  // m^2; products of smaller numbers would be lost
  if (!(squared_length > kPoint)) {
    p = a;
    return a.squaredNorm() < squared_limit && cone.holds(a);
  }
  // From the line's nearest point to the apex on, so that a long line loses no digits.
  const double foot = -a.dot(D) / squared_length;
  const Vector3d p0 = a + foot * D;
  const double squared_line = p0.squaredNorm();
  if (!(squared_line < squared_limit)) return false;
  const double low = -foot;
  const double high = 1.0 - foot;
  const double nearest = std::clamp(0.0, low, high);
  const auto at = [&](double t) -> Vector3d { return t == low ? a : t == high ? b : Vector3d(p0 + t * D); };
  p = at(nearest);
  if (cone.holds(p)) return p.squaredNorm() < squared_limit;
  double best = squared_limit;
  const auto offer = [&](double t) {
    const double squared = squared_line + t * t * squared_length;
    if (!(squared < best)) return;
    best = squared;
    p = at(t);
  };
  const Crossings found = crossings(cone, p0, D);
  for (int i = 0; i < found.count; ++i) {
    const double t = found.t[static_cast<std::size_t>(i)];
    if (t >= low && t <= high && p0.z() + t * D.z() >= 0.0) offer(t);
  }
  if (nearest != low && cone.holds(a)) offer(low);
  if (nearest != high && cone.holds(b)) offer(high);
  return best < squared_limit;
}

void nearest_on_polygon(const ConeShape& cone, std::span<const Vector3d> corners, Nearest& best) {
  const std::size_t count = corners.size();
  Vector3d area_vector;
  Vector3d normal;
  if (!normal_of(corners, area_vector, normal)) return nearest_on_edges(cone, corners, best);
  const double area = area_vector.norm();
  double d = normal.dot(corners[0]);
  if (d < 0.0) {
    d = -d;
    normal = -normal;
  }
  const double limit = cone.reach(d, best.distance);
  if (!(d < limit)) return;
  constexpr double kRounding = 1e-13;
  Vector3d q;
  if (nearest_on_plane(cone, normal, d, q)) {
    if (!(q.squaredNorm() < limit * limit)) return;
  } else if (d > kRounding * corners[0].norm()) {
    return;
  } else {
    q.setZero();  // the apex lies in the plane, and which side it is on is a matter of rounding
  }
  // The edges beyond which q lies.
  const double sign = area_vector.dot(normal) > 0.0 ? 1.0 : -1.0;
  bool inside = true;
  Nearest on_edges{limit};
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d& from = corners[i];
    const Vector3d& to = corners[i + 1 == count ? 0 : i + 1];
    const Vector3d edge = to - from;
    const double side = sign * normal.dot(edge.cross(q - from));
    if (side >= 0.0) continue;
    if (side < -kRounding * area) inside = false;
    Vector3d p;
    if (nearest_on_segment(cone, from, to, on_edges.distance, p)) on_edges.offer(p.norm(), p);
  }
  if (inside) {
    best.offer(q.norm(), q);
  } else if (on_edges.found) {
    best.offer(on_edges.distance, on_edges.p);
  }
}

}  // namespace cellmirror::ranging
