// Error messages for poses that inverse kinematics cannot reach.
#pragma once

#include "rt_core/base/pose.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/cell/robot_model.hpp"
#include "rt_core/inverse_kinematics/inverse_kinematics.hpp"

namespace cellmirror::planning {

// `answer` is not solved; X_ZG is the pose that was asked for and X_ZN the nearest that was found, in the robot's ZP
// frame. Lengths in mm and angles in degrees, as in SCRIPT.
[[nodiscard]] Error unreachable(const RobotModel& robot, const inverse_kinematics::Answer& answer, const Pose& X_ZG,
                                const Pose& X_ZN);

// What the planner says of a path to X_ZG that cannot be gone, with the hint for robots that cannot meet every pose.
[[nodiscard]] Error line_refused(const RobotModel& robot, Error why, const Pose& X_ZG);

// "x 1000.0 y 0.0 z 0.0 mm, roll -90.0 pitch 0.0 yaw -90.0 degrees".
[[nodiscard]] std::string pose_text(const Pose& X);

}  // namespace cellmirror::planning
