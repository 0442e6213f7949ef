// The clipping planes of a volume (VV_CLIP, VV_CLIP_POS) in its frame V. Any thread.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "rt_core/ports/volume_settings.hpp"

namespace cellmirror::volume {

// n . p <= distance is kept.
struct HalfSpace {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  double distance = 0;  // m
};

[[nodiscard]] Eigen::Vector3d normal_of(const VolumePlane& plane);
// Those that clip, at most kVolumePlanes. A plane that is not finite clips nothing.
[[nodiscard]] std::vector<HalfSpace> clipping(const VolumeSettings& settings);
// Where a plane cuts the box of +- half_extent: the corners of a convex polygon in order, none or 3 to 6.
[[nodiscard]] std::vector<Eigen::Vector3d> outline(const VolumePlane& plane, const Eigen::Vector3d& half_extent_m);

}  // namespace cellmirror::volume
