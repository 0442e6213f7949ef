// Projections for pictures of volumes: clip space with y downwards, as the renderer's.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace cellmirror::phantoms {

struct Camera {
  Eigen::Vector3d from = Eigen::Vector3d(0, -1, 0);
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  double opening_angle = 0.5;  // rad, vertical
  double height_m = 0;         // above 0: parallel
  double near_m = 0.05;
  double far_m = 10;
};

inline Eigen::Matrix4d clip_from_world(const Camera& camera, int width, int height) {
  const Eigen::Vector3d back = (camera.from - camera.to).normalized();
  const Eigen::Vector3d right = camera.up.cross(back).normalized();
  Eigen::Isometry3d X_WE = Eigen::Isometry3d::Identity();
  X_WE.translation() = camera.from;
  X_WE.linear() << right, back.cross(right), back;
  const double half = camera.height_m > 0 ? camera.height_m / 2 : std::tan(camera.opening_angle / 2);
  const double aspect = static_cast<double>(width) / height;
  const double depth = camera.far_m - camera.near_m;
  Eigen::Matrix4d projection = Eigen::Matrix4d::Zero();
  projection(0, 0) = 1 / (half * aspect);
  projection(1, 1) = -1 / half;
  if (camera.height_m > 0) {
    projection(2, 2) = -2 / depth;
    projection(2, 3) = -(camera.far_m + camera.near_m) / depth;
    projection(3, 3) = 1;
  } else {
    projection(2, 2) = -(camera.far_m + camera.near_m) / depth;
    projection(2, 3) = -2 * camera.far_m * camera.near_m / depth;
    projection(3, 2) = -1;
  }
  return projection * X_WE.inverse().matrix();
}

}  // namespace cellmirror::phantoms
