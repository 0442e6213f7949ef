// Where the TCP is to go: the Cartesian modes of POS_ROB (manual 1.2.1; docs/script.md, "Motion").
#pragma once

#include <Eigen/Core>

#include "rt_core/base/pose.hpp"
#include "scripts/commands/motion_host.hpp"

namespace cellmirror::app {

// The target in the robot's ZP frame. `mode` is one of the four Cartesian ones, `given` as in MotionTarget, X_ZT where
// the TCP was commanded to before, R_ZS the axes of the screen in the ZP frame.
[[nodiscard]] Pose target_pose(TargetMode mode, const Pose& given, const Pose& X_ZT, const Eigen::Matrix3d& R_ZS);

}  // namespace cellmirror::app
