#include "rt_core/base/pose.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror {

Eigen::Matrix3d rotation_from_rpy(double roll, double pitch, double yaw) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
          AngleAxisd(roll, Vector3d::UnitX()))
      .toRotationMatrix();
}

Eigen::Vector3d rpy_from_rotation(const Eigen::Matrix3d& R) {
  const double sin_pitch = std::clamp(-R(2, 0), -1.0, 1.0);
  const double cos_pitch = std::hypot(R(0, 0), R(1, 0));
  constexpr double kGimbalLock = 1e-9;
  if (cos_pitch < kGimbalLock) return {0.0, std::atan2(sin_pitch, cos_pitch), std::atan2(-R(0, 1), R(1, 1))};
  return {std::atan2(R(2, 1), R(2, 2)), std::atan2(sin_pitch, cos_pitch), std::atan2(R(1, 0), R(0, 0))};
}

Pose pose_from_xyz_rpy(const Eigen::Vector3d& xyz_m, const Eigen::Vector3d& rpy_rad) {
  Pose X = Pose::Identity();
  X.linear() = rotation_from_rpy(rpy_rad.x(), rpy_rad.y(), rpy_rad.z());
  X.translation() = xyz_m;
  return X;
}

}  // namespace cellmirror
