// Plans the moves of one robot: to joint positions, to poses of its TCP, along lines and arcs. What SCRIPT commands and
// robot programs have in common. Belongs to the thread that owns the cell; a search takes some milliseconds.
#pragma once

#include <memory>
#include <optional>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/cell/robot_model.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/motion/move.hpp"
#include "rt_core/planning/robot_kinematics.hpp"
#include "rt_core/ports/motion_target.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::planning {

// Where a robot was last commanded to.
struct MotionGoal {
  JointValues joints{};      // rad or m
  std::optional<Pose> X_ZT;  // as it was commanded, where the task is the whole pose
  std::shared_ptr<const kinematics::Chain> chain;
};

struct PlannedMove {
  motion::Move move;
  MotionGoal goal;
};

// What a move is planned for. All outlive the call; `kinematics` is up to date.
struct PlanningContext {
  const RobotModel& robot;
  RobotKinematics& kinematics;
  const RobotParameters& parameters;  // those of the robot, or what a program made of them
  const Clock& clock;                 // for the time limit of inverse kinematics
};

// Whether the mode gives joint positions instead of a pose.
[[nodiscard]] bool is_joint_target(TargetMode mode);

// A Cartesian mode of POS_ROB (manual 1.2.1; docs/script.md, "Motion") as a pose in the robot's ZP frame. `given` as in
// MotionTarget, X_ZT where the TCP was commanded to before, R_ZS the axes of the screen in the ZP frame.
[[nodiscard]] Pose target_pose(TargetMode mode, const Pose& given, const Pose& X_ZT, const Eigen::Matrix3d& R_ZS);

// A mode of joints as joint positions. Refused: too many values, values beyond a limit.
[[nodiscard]] Result<JointValues> target_joints(const RobotModel& robot, const MotionTarget& target,
                                                const JointValues& from);

// The posture that reaches the pose, near `from`. Refused, with the nearest pose: there is none.
[[nodiscard]] Result<MotionGoal> reach(const PlanningContext& context, const Pose& X_ZG, const JointValues& from);

// Point to point. Refused: see motion::plan_joint_move().
[[nodiscard]] Result<PlannedMove> plan_joints(const PlanningContext& context, MotionGoal goal);

// The TCP on a straight line from the posture `from`, or through X_ZV on an arc. Refused: it cannot be followed.
[[nodiscard]] Result<PlannedMove> plan_line(const PlanningContext& context, const JointValues& from, const Pose& X_ZG);
[[nodiscard]] Result<PlannedMove> plan_arc(const PlanningContext& context, const JointValues& from, const Pose& X_ZV,
                                           const Pose& X_ZG);

}  // namespace cellmirror::planning
