#include "app/owner/programs/program_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/owner/programs/move_settings.hpp"
#include "rt_core/planning/move_planner.hpp"

namespace cellmirror::app {

using planning::MotionGoal;
using planning::PlannedMove;

namespace {

using program::MotionProgress;
using program::MoveCommand;
using program::PathKind;
using program::Target;
using program::TargetKind;

constexpr double kLongestDelay = 86'400 * 365.0;  // s

MotionProgress::End end_of(motion::Outcome outcome) {
  switch (outcome) {
    case motion::Outcome::stopped:
      return MotionProgress::End::stopped;
    case motion::Outcome::superseded:
      return MotionProgress::End::superseded;
    case motion::Outcome::blocked:
      return MotionProgress::End::blocked;
    case motion::Outcome::none:
    case motion::Outcome::arrived:
      break;
  }
  return MotionProgress::End::arrived;
}

bool of_joints(const Target& target) {
  return target.kind == TargetKind::joints_absolute || target.kind == TargetKind::joints_relative;
}

// Joints beyond those of the target stay.
JointValues joints_of(const Target& target, const JointValues& from) {
  JointValues out = from;
  for (std::size_t i = 0; i < target.joint_count; ++i)
    out[i] = target.kind == TargetKind::joints_relative ? from[i] + target.joints[i] : target.joints[i];
  return out;
}

Result<void> check_joint_count(const RobotModel& robot, const Target& target) {
  if (!of_joints(target) || target.joint_count <= robot.joint_count()) return {};
  return fail(fmt::format("the target has {} joint values, {} has {} joints", target.joint_count, robot.id(),
                          robot.joint_count()),
              "give one value a joint");
}

}  // namespace

Result<void> CellProgramMotion::check(std::string_view id) const {
  if (auto simulated = port_.check_simulated(id); !simulated) return simulated;
  const RobotModel* robot = cell_.robot(id);
  if (robot == nullptr) return std::unexpected(cell_.explain_robot(id));
  return motion_.check_free(*robot);
}

bool CellProgramMotion::room(std::string_view id) const {
  const auto record = motion_.open(cell_.robot(id), id);
  return record && (*record)->pending.count() < motion::kMoveQueue;
}

Result<CellProgramMotion::Arm*> CellProgramMotion::arm(std::string_view id) const {
  const RobotModel* robot = cell_.robot(id);
  if (robot == nullptr) return std::unexpected(cell_.explain_robot(id));
  Arm& arm = arms_.try_emplace(std::string(id)).first->second;
  if (auto updated = arm.kinematics.update(cell_, *robot); !updated) return std::unexpected(updated.error());
  return &arm;
}

Result<std::uint32_t> CellProgramMotion::move(std::string_view id, const MoveCommand& command, Timestamp begin) {
  if (auto free = check(id); !free) return std::unexpected(free.error());
  const RobotModel& robot = *cell_.robot(id);
  auto record = motion_.open(&robot, id);
  if (!record) return std::unexpected(record.error());
  auto arm = this->arm(id);
  if (!arm) return std::unexpected(arm.error());
  auto parameters = parameters_for(robot.parameters(), joint_kinds(id), command);
  if (!parameters) return std::unexpected(parameters.error());
  MotionGoal from = motion_.goal_of(robot, **record, (*arm)->kinematics.chain());
  const Pose X_ZS = from.X_ZT ? *from.X_ZT : (*arm)->kinematics.X_ZT(from.joints);
  auto planned = plan({robot, **arm, std::move(from), X_ZS, *parameters}, command);
  if (!planned) return std::unexpected(planned.error());
  planned->move.begin = begin;
  planned->move.follows_on = true;
  const std::uint32_t ticket = (*record)->pending.next_id();
  if (auto sent = motion_.send(robot, **record, std::move(*planned), motion::Start::queue); !sent)
    return std::unexpected(sent.error());
  return ticket;
}

Result<PlannedMove> CellProgramMotion::plan(const Scene& scene, const MoveCommand& command) const {
  if (auto fits = check_joint_count(scene.robot, command.target); !fits) return std::unexpected(fits.error());
  return command.path == PathKind::joints ? plan_joints(scene, command) : plan_path(scene, command);
}

Result<Pose> CellProgramMotion::pose_of(const Scene& scene, const Target& target) const {
  Pose X = target.pose;
  switch (target.kind) {
    case TargetKind::joints_absolute:
    case TargetKind::joints_relative:
      X = scene.arm.kinematics.X_ZT(joints_of(target, scene.from.joints));
      break;
    case TargetKind::pose_absolute:
      break;
    case TargetKind::pose_relative:
      X.translation() = scene.X_ZS.translation() + target.pose.translation();
      X.linear() = target.pose.linear() * scene.X_ZS.linear();
      break;
    case TargetKind::tool_relative:
      X = scene.X_ZS * target.pose;
      break;
  }
  if (!kinematics::is_pose(X)) return fail("the target is not a pose of finite numbers");
  return X;
}

Result<PlannedMove> CellProgramMotion::plan_joints(const Scene& scene, const MoveCommand& command) const {
  const planning::PlanningContext context{scene.robot, scene.arm.kinematics, scene.parameters, clock_};
  Result<MotionGoal> goal = MotionGoal{.joints = {}, .X_ZT = {}, .chain = scene.arm.kinematics.chain()};
  if (of_joints(command.target)) {
    goal->joints = joints_of(command.target, scene.from.joints);
  } else {
    const auto X_ZG = pose_of(scene, command.target);
    if (!X_ZG) return std::unexpected(X_ZG.error());
    goal = planning::reach(context, *X_ZG, scene.from.joints);
    if (!goal) return std::unexpected(goal.error());
  }
  auto planned = planning::plan_joints(context, std::move(*goal));
  if (!planned) return planned;
  planned->move.fly_type = scene.parameters.fly_type;
  planned->move.fly_parameter = scene.parameters.fly_parameter;
  return planned;
}

Result<PlannedMove> CellProgramMotion::plan_path(const Scene& scene, const MoveCommand& command) const {
  const planning::PlanningContext context{scene.robot, scene.arm.kinematics, scene.parameters, clock_};
  const auto X_ZG = pose_of(scene, command.target);
  if (!X_ZG) return std::unexpected(X_ZG.error());
  if (command.path != PathKind::circular) return planning::plan_line(context, scene.from.joints, *X_ZG);
  if (!command.via) return fail("a circular move needs a via point");
  if (auto fits = check_joint_count(scene.robot, *command.via); !fits) return std::unexpected(fits.error());
  const auto X_ZV = pose_of(scene, *command.via);
  if (!X_ZV) return std::unexpected(X_ZV.error());
  return planning::plan_arc(context, scene.from.joints, *X_ZV, *X_ZG);
}

Result<std::uint32_t> CellProgramMotion::delay(std::string_view id, double seconds, Timestamp begin) {
  if (!std::isfinite(seconds) || seconds < 0 || seconds > kLongestDelay)
    return fail(fmt::format("a delay of {:g} s", seconds), "it takes from no time to a year");
  if (auto free = check(id); !free) return std::unexpected(free.error());
  auto record = motion_.open(cell_.robot(id), id);
  if (!record) return std::unexpected(record.error());
  PlannedMove planned;
  planned.move.kind = motion::MoveKind::delay;
  planned.move.delay_s = seconds;
  planned.move.begin = begin;
  planned.move.follows_on = true;
  const std::uint32_t ticket = (*record)->pending.next_id();
  if (auto sent = motion_.send(*cell_.robot(id), **record, std::move(planned), motion::Start::queue); !sent)
    return std::unexpected(sent.error());
  return ticket;
}

Result<void> CellProgramMotion::set_tool(std::string_view id, const std::optional<Pose>& X_PT) {
  if (X_PT && !kinematics::is_pose(*X_PT)) return fail("the tool centre point is not a pose of finite numbers");
  if (cell_.robot(id) == nullptr) {
    // A program ends behind its deleted robot: the next robot of that name must not get its tool.
    if (const auto gone = arms_.find(id); gone != arms_.end()) arms_.erase(gone);
    return std::unexpected(cell_.explain_robot(id));
  }
  arms_.try_emplace(std::string(id)).first->second.kinematics.set_tool(X_PT);
  return {};
}

MotionProgress CellProgramMotion::progress(std::string_view id) const {
  MotionProgress progress;
  const auto record = motion_.open(cell_.robot(id), id);
  if (!record) return progress;
  const motion::MotionState state = port_.motion(id);
  const PendingMoves& pending = (*record)->pending;
  progress.finished = std::max(state.finished, pending.ended());
  // Moves that were given up never came to an end in the tick.
  progress.end = pending.ended() > state.finished ? MotionProgress::End::stopped : end_of(state.outcome);
  progress.finished_time = state.finished_time;
  progress.moving = pending.in_flight() || state.moving;
  progress.pace = state.pace;
  return progress;
}

Result<void> CellProgramMotion::set_pace(std::string_view id, double pace) {
  if (auto simulated = port_.check_simulated(id); !simulated) return simulated;
  return port_.set_pace(id, pace);
}

Result<void> CellProgramMotion::hold_behind(std::string_view id, std::uint32_t ticket) {
  if (auto simulated = port_.check_simulated(id); !simulated) return simulated;
  return port_.hold_behind(id, ticket);
}

Result<void> CellProgramMotion::stop(std::string_view id) {
  const auto record = motion_.open(cell_.robot(id), id);
  if (!record) return std::unexpected(record.error());
  if ((*record)->pending.in_flight()) return motion_.stop(id);
  if (auto held = port_.hold_behind(id, 0); !held) return held;
  return port_.set_pace(id, 1);
}

std::span<const JointKind> CellProgramMotion::joint_kinds(std::string_view id) const {
  const RobotModel* robot = cell_.robot(id);
  if (robot == nullptr) return {};
  std::vector<JointKind>& kinds = arms_.try_emplace(std::string(id)).first->second.joint_kinds;
  kinds.clear();
  for (const RobotJoint& joint : robot->joints()) kinds.push_back(joint.kind);
  return kinds;
}

JointValues CellProgramMotion::joints(std::string_view id) const {
  const RobotModel* robot = cell_.robot(id);
  return robot == nullptr ? JointValues() : port_.positions()[robot->slot()];
}

Result<Pose> CellProgramMotion::position(std::string_view id) const {
  const auto arm = this->arm(id);
  if (!arm) return std::unexpected(arm.error());
  return (*arm)->kinematics.X_ZT(joints(id));
}

double CellProgramMotion::program_delay(std::string_view id) const {
  const RobotModel* robot = cell_.robot(id);
  return robot == nullptr ? 0 : robot->parameters().program_delay_s;
}

}  // namespace cellmirror::app
