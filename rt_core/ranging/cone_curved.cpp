// Round bodies with an axis. Their side is made of straight lines (generators), each of which is cut by the cone in
// closed form; the normal is the same all along one, so that on each the nearest point in the cone is also the one met
// most squarely, as on a plane. What is left is a search over one angle.
//
// From outside of a convex body K with the apex O: let L be the points of K in the cone that are within a distance s,
// a convex set from which every way to O stays in L as long as it stays in K. Seen from O along the axis, the side that
// can be seen is an arc that each ray from O meets once; so the generators of it that reach L are an interval, whatever
// s, and the search has one valley: golden section finds its ground. The same holds for sets that are beyond the cone
// by no more than a bound, which is what leads the search to generators that meet the cone at all.
// From inside there may be several valleys, and where the beam's incidence is limited too: then the search samples all
// around first. A wall that sends nothing back hides nothing, so a limited beam also sees walls from within.
#include "rt_core/ranging/cone_curved.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rt_core/ranging/cone_search.hpp"
#include "rt_core/ranging/cone_sphere.hpp"

namespace cellmirror::ranging {

namespace {

using Eigen::Vector3d;

struct Round {
  Vector3d centre;
  Vector3d e1, e2, axis;
  double radius;
  double half_length;
  double apex_1, apex_2;  // the apex from the centre, across the axis
  double apex_3;          // and along it

  Round(const Pose& X_SG, double r, double h)
      : centre(X_SG.translation()),
        e1(X_SG.linear().col(0)),
        e2(X_SG.linear().col(1)),
        axis(X_SG.linear().col(2)),
        radius(r),
        half_length(h),
        apex_1(-centre.dot(e1)),
        apex_2(-centre.dot(e2)),
        apex_3(-centre.dot(axis)) {}

  [[nodiscard]] double apex_from_axis() const { return std::hypot(apex_1, apex_2); }
  [[nodiscard]] double towards_apex() const { return std::atan2(apex_2, apex_1); }
};

class Side {
 public:
  Side(const ConeShape& cone, const Round& body, Nearest& best) : cone_(cone), body_(body), best_(best) {}

  Rank operator()(double angle) const {
    const Vector3d normal = std::cos(angle) * body_.e1 + std::sin(angle) * body_.e2;
    const Vector3d middle = body_.centre + body_.radius * normal;
    const Vector3d half = body_.half_length * body_.axis;
    Vector3d p;
    Rank rank = rank_of_segment(cone_, middle - half, middle + half, p);
    if (rank.violation > 0.0) {
      rank.violation += kBeyondCone;
      return rank;
    }
    constexpr double kAnywhere = 1e150;
    const double reach = cone_.reach(std::abs(normal.dot(middle)), kAnywhere);
    if (rank.distance <= reach) {
      best_.offer(rank.distance, p);
    } else {
      rank.violation = 1.0 - reach / rank.distance;  // below kBeyondCone
    }
    return rank;
  }

 private:
  static constexpr double kBeyondCone = 1.0;
  const ConeShape& cone_;
  const Round& body_;
  Nearest& best_;
};

// A point of the side under an allowed incidence.
bool comes_back(const ConeShape& cone, const Round& body, const Vector3d& p) {
  const Vector3d from_centre = p - body.centre;
  const Vector3d normal = (from_centre - from_centre.dot(body.axis) * body.axis) / body.radius;
  return p.norm() <= cone.reach(std::abs(normal.dot(p)), p.norm());
}

// `inside`: the apex is inside.
void nearest_on_side(const ConeShape& cone, const Round& body, bool inside, Nearest& best) {
  const double from_axis = body.apex_from_axis();
  const double beyond_end = std::max(0.0, std::abs(body.apex_3) - body.half_length);
  const double least = std::hypot(from_axis - body.radius, beyond_end);
  if (!(least < best.distance)) return;
  const bool limited = cone.cos_incidence > 0.0;
  if (!inside && from_axis > body.radius) {
    ConeShape any_incidence = cone;
    any_incidence.cos_incidence = 0.0;
    Nearest found{best.distance};
    const Side side(any_incidence, body, found);
    const double middle = body.towards_apex();
    const Rank front = side(middle);
    constexpr double kRounding = 1e-14;
    const bool nearest_of_all = front.violation == 0.0 && front.distance <= least * (1.0 + kRounding);
    const double half = std::acos(body.radius / from_axis);
    if (!nearest_of_all) golden_section(middle - half, middle + half, side);
    if (!limited && !found.found) return;
    if (!limited || (found.found && comes_back(cone, body, found.p))) return best.offer(found.distance, found.p);
  } else if (!inside && !limited) {
    return;  // an end stands before it
  }
  all_around(Side(cone, body, best));
}

// A flat end: the disc about `centre` with the normal along the body's axis. Its chords are parallel segments across a
// convex body, and so have one valley.
void nearest_on_disc(const ConeShape& cone, const Round& body, const Vector3d& centre, Nearest& best) {
  Vector3d normal = body.axis;
  double d = normal.dot(centre);
  if (d < 0.0) {
    d = -d;
    normal = -normal;
  }
  const double limit = cone.reach(d, best.distance);
  const Vector3d foot = d * normal;
  const double foot_from_centre = (foot - centre).norm();
  const double gap = std::max(0.0, foot_from_centre - body.radius);
  if (!(d * d + gap * gap < limit * limit)) return;
  Vector3d q;
  if (nearest_on_plane(cone, normal, d, q)) {
    if (!(q.squaredNorm() < limit * limit)) return;
    if ((q - centre).squaredNorm() <= body.radius * body.radius) return best.offer(q.norm(), q);
  } else if (d > 1e-13 * (centre.norm() + body.radius)) {
    return;
  } else if (gap == 0.0) {
    return best.offer(0.0, Vector3d::Zero());  // the apex lies on it
  }
  if (gap > 0.0) {
    const Vector3d nearest = centre + body.radius / foot_from_centre * (foot - centre);
    if (cone.holds(nearest)) return best.offer(nearest.norm(), nearest);
  }
  Nearest found{limit};
  golden_section(-0.5 * std::numbers::pi, 0.5 * std::numbers::pi, [&](double angle) {
    const Vector3d middle = centre + body.radius * std::sin(angle) * body.e2;
    const Vector3d half = body.radius * std::cos(angle) * body.e1;
    Vector3d p;
    const Rank rank = rank_of_segment(cone, middle - half, middle + half, p);
    if (rank.violation == 0.0) found.offer(rank.distance, p);
    return rank;
  });
  if (found.found) best.offer(found.distance, found.p);
}

}  // namespace

void nearest_on_cylinder(const ConeShape& cone, const Pose& X_SG, double radius, double half_length, Nearest& best) {
  const Round body(X_SG, radius, half_length);
  const Vector3d half = half_length * body.axis;
  const bool inside = body.apex_from_axis() <= radius && std::abs(body.apex_3) <= half_length;
  nearest_on_disc(cone, body, body.centre + half, best);
  nearest_on_disc(cone, body, body.centre - half, best);
  nearest_on_side(cone, body, inside, best);
}

void nearest_on_capsule(const ConeShape& cone, const Pose& X_SG, double radius, double half_length, Nearest& best) {
  const Round body(X_SG, radius, half_length);
  const double beyond_end = std::max(0.0, std::abs(body.apex_3) - half_length);
  const bool inside = std::hypot(body.apex_from_axis(), beyond_end) < radius;
  for (const double end : {-1.0, 1.0}) {
    const Vector3d outward = end * body.axis;
    const Vector3d centre = body.centre + half_length * outward;
    const Seam seam{true, outward};
    if (!inside) nearest_on_sphere_from_outside(cone, centre, radius, seam, best);
    if (inside || cone.cos_incidence > 0.0) nearest_on_sphere_from_inside(cone, centre, radius, seam, best);
  }
  nearest_on_side(cone, body, inside, best);
}

}  // namespace cellmirror::ranging
