// Poses and the one definition of roll, pitch and yaw. Names are in monogram notation: X_AB is the pose of frame B in
// frame A, p_AB_C the position of B's origin from A's, expressed in C; adjacent letters cancel: X_AC = X_AB * X_BC.
#pragma once

#include <Eigen/Geometry>

namespace cellmirror {

using Pose = Eigen::Isometry3d;  // metres; right-handed

// Fixed axes: roll about x, then pitch about y, then yaw about z: R = Rz(yaw) Ry(pitch) Rx(roll) (docs/script.md, our
// definition; URDF's rpy is the same). Radians.
[[nodiscard]] Eigen::Matrix3d rotation_from_rpy(double roll, double pitch, double yaw);
// The inverse: pitch within [-pi/2, pi/2]; at its ends roll is 0 and yaw takes the whole rotation.
[[nodiscard]] Eigen::Vector3d rpy_from_rotation(const Eigen::Matrix3d& R);
[[nodiscard]] Pose pose_from_xyz_rpy(const Eigen::Vector3d& xyz_m, const Eigen::Vector3d& rpy_rad);

}  // namespace cellmirror
