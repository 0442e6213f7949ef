// What STVW or a cell file sets of a view; what is not given stays. Plain data, SI.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace cellmirror {

struct ViewChange {
  std::optional<Eigen::Vector3d> viewpoint;  // m, world
  std::optional<Eigen::Vector3d> lookpoint;
  std::optional<double> twist;          // rad
  std::optional<double> opening_angle;  // rad, vertical
  std::optional<double> near_distance;  // m, from the viewpoint
  std::optional<double> far_distance;
};

// Of a cell file.
struct ViewSetting {
  int id = 0;  // 0 to 6
  ViewChange change;
};

}  // namespace cellmirror
