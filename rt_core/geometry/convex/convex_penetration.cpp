#include <algorithm>
#include <cmath>
#include <limits>

#include "rt_core/geometry/convex.hpp"
#include "rt_core/geometry/convex/convex_overlap.hpp"
#include "rt_core/geometry/convex/convex_pairs.hpp"

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

// Part of the size below which the direction between the nearest points of two cores is rounding: the overlap of the
// cores, then about 0, gives the normal.
constexpr double kTouching = 1e-11;

// In frame A, for cores in their order.
Penetration ordered_penetration(const ConvexCore& a, const ConvexCore& b, RelativePose X_AB) {
  constexpr double kAnyDistance = std::numeric_limits<double>::infinity();
  const double size = size_of(a, b, X_AB);
  const CoreDistance apart = core_distance(a, b, X_AB, kAnyDistance);
  Penetration out;
  if (apart.distance > kTouching * size) {
    out.normal = (apart.p_b - apart.p_a).normalized();
    out.depth = std::max(0.0, a.skin + b.skin - apart.distance);
    out.point = 0.5 * (apart.p_a + a.skin * out.normal + apart.p_b - b.skin * out.normal);
    return out;
  }
  const LeastOverlap overlap = least_overlap(a, b, X_AB);
  out.normal = overlap.normal;
  out.depth = overlap.depth + a.skin + b.skin;
  // Where they would touch last: parted by a way that is large enough for clear nearest points.
  X_AB.t += (overlap.depth + size) * overlap.normal;
  const CoreDistance parted = core_distance(a, b, X_AB, kAnyDistance);
  out.point = parted.p_a + 0.5 * (a.skin - b.skin - overlap.depth) * overlap.normal;
  return out;
}

}  // namespace

Penetration convex_penetration(const ConvexCore& a, const Pose& X_WA, const ConvexCore& b, const Pose& X_WB) CELL_RT {
  const bool in_order = comes_first(a, b);
  const Pose& X_WF = in_order ? X_WA : X_WB;
  Penetration out = in_order ? ordered_penetration(a, b, RelativePose(X_WA, X_WB))
                             : ordered_penetration(b, a, RelativePose(X_WB, X_WA));
  out.normal = X_WF.linear() * out.normal;
  if (!in_order) out.normal = -out.normal;
  out.point = X_WF * out.point;
  if (!std::isfinite(out.depth + out.normal.sum() + out.point.sum())) return {};
  return out;
}

}  // namespace cellmirror::geometry
