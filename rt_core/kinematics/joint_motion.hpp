// The motion of one joint: what every forward kinematics here is made of.
#pragma once

#include <Eigen/Geometry>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror::kinematics {

// X_RJ becomes the pose after the joint's motion: rotation about or translation along `axis` (a unit vector in the
// moved frame), by rad or m.
inline void apply_joint(JointKind kind, const Eigen::Vector3d& axis, double value, Pose& X_RJ) CELL_RT {
  if (kind == JointKind::prismatic) {
    X_RJ.translation() += X_RJ.linear() * (value * axis);
  } else {
    const Eigen::Matrix3d R = X_RJ.linear();
    X_RJ.linear().noalias() = R * Eigen::AngleAxisd(value, axis).toRotationMatrix();
  }
}

}  // namespace cellmirror::kinematics
