#include "rt_core/ranging/cone.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "rt_core/ranging/cone_curved.hpp"
#include "rt_core/ranging/cone_section.hpp"
#include "rt_core/ranging/cone_shape.hpp"
#include "rt_core/ranging/mesh_walk.hpp"

namespace cellmirror::ranging {

namespace {

using Eigen::Vector3d;

void nearest_on_box(const ConeShape& cone, const Pose& X_SG, const Vector3d& half, Nearest& best) {
  for (int i = 0; i < 3; ++i) {
    const Vector3d out = half[i] * X_SG.linear().col(i);
    const Vector3d a = half[(i + 1) % 3] * X_SG.linear().col((i + 1) % 3);
    const Vector3d b = half[(i + 2) % 3] * X_SG.linear().col((i + 2) % 3);
    for (const double side : {-1.0, 1.0}) {
      const Vector3d centre = X_SG.translation() + side * out;
      const std::array<Vector3d, 4> corners{centre - a - b, centre + a - b, centre + a + b, centre - a + b};
      nearest_on_polygon(cone, corners, best);
    }
  }
}

// The whole box around the solid is out of the cone or of reach.
bool out_of_sight(const geometry::Solid& solid, const Pose& X_SG, const ConeShape& cone, double up_to) {
  constexpr double kRounding = 1e-9;  // m, and in parts of the radius
  const double radius = solid.radius * (1.0 + kRounding) + kRounding;
  const Vector3d centre = X_SG * solid.centre;
  const double reach = up_to + radius;
  return !(centre.squaredNorm() < reach * reach) || cone.beyond(centre) > radius;
}

}  // namespace

std::optional<ConeShape> cone_shape(const Cone& cone) noexcept {
  constexpr double kRight = 0.5 * std::numbers::pi;
  // Where the sine or cosine would be lost among the digits of the other.
  constexpr double kLeast = 1e-6;
  if (!(cone.half_angle_rad > 0.0) || !(cone.half_angle_rad < kRight)) return std::nullopt;
  if (std::isnan(cone.max_incidence_rad)) return std::nullopt;
  const double half_angle = std::clamp(cone.half_angle_rad, kLeast, kRight - kLeast);
  ConeShape out{std::sin(half_angle), std::cos(half_angle), 0.0};
  if (cone.max_incidence_rad < kRight - kLeast) out.cos_incidence = std::cos(std::max(0.0, cone.max_incidence_rad));
  return out;
}

void nearest_on_solid(const geometry::Solid& solid, const Pose& X_SG, const ConeShape& cone, Nearest& best,
                      std::uint32_t& triangle) noexcept {
  if (!X_SG.matrix().allFinite() || out_of_sight(solid, X_SG, cone, best.distance)) return;
  switch (solid.shape) {
    case Shape::box:
      return nearest_on_box(cone, X_SG, solid.core.half, best);
    case Shape::cylinder:
      return nearest_on_cylinder(cone, X_SG, solid.core.half.x(), solid.core.half.z(), best);
    case Shape::sphere:
      return nearest_on_sphere(cone, X_SG.translation(), solid.core.skin, best);
    case Shape::capsule:
      return nearest_on_capsule(cone, X_SG, solid.core.skin, solid.core.half.z(), best);
    case Shape::mesh:
      if (solid.tree) nearest_on_mesh(cone, *solid.tree, X_SG, best, triangle);
      return;
  }
}

std::optional<ConeHit> nearest_in_cone(const geometry::Solid& solid, const Pose& X_SG, const Cone& cone,
                                       double up_to) noexcept {
  const auto shape = cone_shape(cone);
  if (!shape || !(up_to > 0.0)) return std::nullopt;
  constexpr double kFarthest = 1e150;  // its square is a number
  Nearest best{std::min(up_to, kFarthest)};
  std::uint32_t triangle = 0;
  nearest_on_solid(solid, X_SG, *shape, best, triangle);
  if (!best.found) return std::nullopt;
  return ConeHit{best.distance, best.p};
}

}  // namespace cellmirror::ranging
