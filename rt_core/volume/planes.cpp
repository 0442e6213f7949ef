#include "rt_core/volume/planes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace cellmirror::volume {

namespace {

bool finite(const VolumePlane& plane) {
  return std::isfinite(plane.elevation_rad) && std::isfinite(plane.azimuth_rad) && std::isfinite(plane.distance_m);
}

Eigen::Vector3d corner(const Eigen::Vector3d& half, unsigned bits) {
  return {(bits & 1U) != 0 ? half.x() : -half.x(), (bits & 2U) != 0 ? half.y() : -half.y(),
          (bits & 4U) != 0 ? half.z() : -half.z()};
}

}  // namespace

Eigen::Vector3d normal_of(const VolumePlane& plane) {
  const double level = std::cos(plane.elevation_rad);
  return {level * std::cos(plane.azimuth_rad), level * std::sin(plane.azimuth_rad), std::sin(plane.elevation_rad)};
}

std::vector<HalfSpace> clipping(const VolumeSettings& settings) {
  std::vector<HalfSpace> kept;
  for (const VolumePlane& plane : settings.planes) {
    if (plane.side == VolumePlaneSide::none || !finite(plane)) continue;
    const double sign = plane.side == VolumePlaneSide::beyond ? 1 : -1;
    kept.push_back({sign * normal_of(plane), sign * plane.distance_m});
  }
  return kept;
}

std::vector<Eigen::Vector3d> outline(const VolumePlane& plane, const Eigen::Vector3d& half_extent_m) {
  if (!finite(plane) || !half_extent_m.allFinite()) return {};
  const Eigen::Vector3d normal = normal_of(plane);
  const auto beyond = [&](const Eigen::Vector3d& p) { return normal.dot(p) - plane.distance_m; };
  std::vector<Eigen::Vector3d> points;
  for (unsigned from = 0; from < 8; ++from) {
    for (const unsigned axis : {1U, 2U, 4U}) {
      if ((from & axis) != 0) continue;
      const Eigen::Vector3d a = corner(half_extent_m, from);
      const Eigen::Vector3d b = corner(half_extent_m, from | axis);
      const double of_a = beyond(a);
      const double of_b = beyond(b);
      if ((of_a < 0) != (of_b < 0)) points.push_back(a + of_a / (of_a - of_b) * (b - a));
    }
  }
  if (points.size() < 3) return {};
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) middle += p / static_cast<double>(points.size());
  const Eigen::Vector3d along = normal.unitOrthogonal();
  const Eigen::Vector3d across = normal.cross(along);
  std::ranges::sort(
      points, {}, [&](const Eigen::Vector3d& p) { return std::atan2(across.dot(p - middle), along.dot(p - middle)); });
  return points;
}

}  // namespace cellmirror::volume
