// Where the TCP is to go.
#include <Eigen/Geometry>

#include "rt_core/planning/move_planner.hpp"

namespace cellmirror::planning {

namespace {

// A long stream of increments must not wear the rotation out.
Pose with_clean_rotation(Pose X) {
  X.linear() = Eigen::Quaterniond(X.linear()).normalized().toRotationMatrix();
  return X;
}

// Translation and rotation about the TCP, both in axes A whose rotation in Z is R_ZA.
Pose moved_in(const Eigen::Matrix3d& R_ZA, const Pose& given, const Pose& X_ZT) {
  Pose X = X_ZT;
  X.translation() += R_ZA * given.translation();
  X.linear() = R_ZA * given.linear() * R_ZA.transpose() * X_ZT.linear();
  return with_clean_rotation(X);
}

}  // namespace

bool is_joint_target(TargetMode mode) {
  return mode != TargetMode::frame_abs && mode != TargetMode::frame_inc && mode != TargetMode::tool_inc &&
         mode != TargetMode::screen_inc;
}

Pose target_pose(TargetMode mode, const Pose& given, const Pose& X_ZT, const Eigen::Matrix3d& R_ZS) {
  switch (mode) {
    case TargetMode::frame_inc:
      return moved_in(Eigen::Matrix3d::Identity(), given, X_ZT);
    case TargetMode::tool_inc:
      return with_clean_rotation(X_ZT * given);
    case TargetMode::screen_inc:
      return moved_in(R_ZS, given, X_ZT);
    default:
      return given;
  }
}

}  // namespace cellmirror::planning
