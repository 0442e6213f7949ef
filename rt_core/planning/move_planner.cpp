#include "rt_core/planning/move_planner.hpp"

#include <utility>

#include "rt_core/motion/planner.hpp"
#include "rt_core/planning/unreachable.hpp"

namespace cellmirror::planning {

namespace {

bool is_whole_pose(const kinematics::Task& task) {
  return task.position_axes == 0b111 && task.orientation == kinematics::OrientationTask::full &&
         task.orientation_required;
}

// The commanded pose as MotionGoal::X_ZT: the next increment starts from it, so that a stream of them does not gather
// the tolerance of the inverse kinematics. Nothing where the task leaves something open.
std::optional<Pose> commanded_pose(const kinematics::Task& task, const Pose& X_ZG) {
  return is_whole_pose(task) ? std::optional(X_ZG) : std::nullopt;
}

Result<PlannedMove> along_path(const PlanningContext& context, Result<motion::PathPlan> path, const Pose& X_ZG) {
  if (!path) return std::unexpected(line_refused(context.robot, std::move(path.error()), X_ZG));
  const kinematics::Task task = context.kinematics.task(context.parameters.inverse_class);
  return PlannedMove{path->move, {path->end, commanded_pose(task, X_ZG), context.kinematics.chain()}};
}

}  // namespace

Result<JointValues> target_joints(const RobotModel& robot, const MotionTarget& target, const JointValues& from) {
  switch (target.mode) {
    case TargetMode::joint_abs:
      return robot.positions_to(target.joints, from);
    case TargetMode::joint_inc:
      return robot.positions_by(target.joints, from);
    case TargetMode::start_position:
      return robot.parameters().start_position;
    default:
      return robot.parameters().reference_position;
  }
}

Result<MotionGoal> reach(const PlanningContext& context, const Pose& X_ZG, const JointValues& from) {
  const kinematics::Task task = context.kinematics.task(context.parameters.inverse_class);
  auto answer = context.kinematics.solve(X_ZG, task, from, context.clock);
  if (!answer) return std::unexpected(answer.error());
  if (!answer->solved) {
    const Pose X_ZN = answer->solutions.empty() ? X_ZG : context.kinematics.X_ZT(answer->solutions.front().q);
    return std::unexpected(unreachable(context.robot, *answer, X_ZG, X_ZN));
  }
  return MotionGoal{answer->solutions.front().q, commanded_pose(task, X_ZG), context.kinematics.chain()};
}

Result<PlannedMove> plan_joints(const PlanningContext& context, MotionGoal goal) {
  auto move = motion::plan_joint_move(*context.kinematics.chain(), context.parameters, goal.joints);
  if (!move) return std::unexpected(move.error());
  return PlannedMove{*move, std::move(goal)};
}

Result<PlannedMove> plan_line(const PlanningContext& context, const JointValues& from, const Pose& X_ZG) {
  return along_path(context, motion::plan_linear_move(*context.kinematics.chain(), context.parameters, from, X_ZG),
                    X_ZG);
}

Result<PlannedMove> plan_arc(const PlanningContext& context, const JointValues& from, const Pose& X_ZV,
                             const Pose& X_ZG) {
  return along_path(
      context,
      motion::plan_circular_move(*context.kinematics.chain(), context.parameters, from, X_ZV.translation(), X_ZG),
      X_ZG);
}

}  // namespace cellmirror::planning
