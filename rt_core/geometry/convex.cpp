#include "rt_core/geometry/convex.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rt_core/geometry/convex/convex_pairs.hpp"

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool finite(const ConvexCore& core) {
  double sum = core.half.sum() + core.skin;
  if (core.kind == CoreKind::triangle) {
    for (const Vector3d& corner : core.corners) sum += corner.sum();
  }
  return std::isfinite(sum);
}
bool finite(const Pose& X) { return std::isfinite(X.translation().sum() + X.linear().sum()); }

// The cores' nearest points become those of the skins.
void put_skins_on(double skin_a, double skin_b, CoreDistance& core) {
  const double skins = skin_a + skin_b;
  if (skins <= 0.0 || core.distance <= 0.0) return;
  const Vector3d towards_b = (core.p_b - core.p_a).normalized();
  if (core.distance > skins) {
    core.distance -= skins;
    core.p_a += skin_a * towards_b;
    core.p_b -= skin_b * towards_b;
    return;
  }
  // A point between the cores that lies in both skins.
  const double from = std::max(0.0, core.distance - skin_b);
  const double to = std::min(core.distance, skin_a);
  const Vector3d middle = core.p_a + 0.5 * (from + to) * towards_b;
  core.distance = 0.0;
  core.p_a = middle;
  core.p_b = middle;
}

ConvexDistance ordered_distance(const ConvexCore& a, const Pose& X_WA, const ConvexCore& b, const Pose& X_WB,
                                double up_to) {
  if (!finite(a) || !finite(b) || !finite(X_WA) || !finite(X_WB)) return {{}, false};
  CoreDistance core = core_distance(a, b, RelativePose(X_WA, X_WB), up_to + a.skin + b.skin);
  ConvexDistance out;
  out.certain = core.certain;
  if (core.beyond) {
    out.points.distance = std::max(up_to, core.distance - a.skin - b.skin);
    return out;
  }
  put_skins_on(a.skin, b.skin, core);
  out.points = {core.distance, X_WA * core.p_a, X_WA * core.p_b};
  if (!std::isfinite(core.distance + core.p_a.sum() + core.p_b.sum())) return {{}, false};
  return out;
}

}  // namespace

ConvexDistance convex_distance(const ConvexCore& a, const Pose& X_WA, const ConvexCore& b, const Pose& X_WB,
                               double up_to) CELL_RT {
  if (comes_first(a, b)) return ordered_distance(a, X_WA, b, X_WB, up_to);
  ConvexDistance out = ordered_distance(b, X_WB, a, X_WA, up_to);
  std::swap(out.points.p_a, out.points.p_b);
  return out;
}

ConvexDistance convex_distance(const ConvexCore& a, const Pose& X_WA, const ConvexCore& b, const Pose& X_WB) CELL_RT {
  return convex_distance(a, X_WA, b, X_WB, kInfinity);
}

}  // namespace cellmirror::geometry
