#include "app/owner/motion/motion_service.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "rt_core/engine/limiter.hpp"

namespace cellmirror::app {

using planning::MotionGoal;
using planning::PlannedMove;

namespace {

// POS_ROB: the increments of the TCP go straight.
MovePath path_of(TargetMode mode) {
  return planning::is_joint_target(mode) || mode == TargetMode::frame_abs ? MovePath::joints : MovePath::linear;
}

}  // namespace

Result<MotionRecord*> MotionService::open(const RobotModel* robot, std::string_view id) {
  if (auto checked = port_.check_simulated(id); !checked) return std::unexpected(checked.error());
  // Deleted with its component a moment ago: the tick has not let go of it yet.
  if (robot == nullptr) return std::unexpected(cell_.explain_robot(id));
  MotionRecord& record = records_.try_emplace(robot->id(), robot->id()).first->second;
  follow(*robot, record);
  return &record;
}

void MotionService::follow(const RobotModel& robot, MotionRecord& record) {
  if (!record.pending.in_flight()) return;
  if (record.pending.follow(port_.motion(robot.id()))) record.goal.reset();
}

void MotionService::follow() {
  for (auto& [id, record] : records_) {
    const RobotModel* robot = record.pending.in_flight() ? cell_.robot(id) : nullptr;
    if (robot != nullptr) follow(*robot, record);
  }
}

void MotionService::cancel(std::string_view robot, const Error& why) {
  const auto found = records_.find(robot);
  if (found == records_.end()) return;
  found->second.pending.cancel(why);
  found->second.goal.reset();
  found->second.chain_of_tick.reset();
}

void MotionService::follow_cell() {
  for (auto& [id, record] : records_) {
    if (cell_.robot(id) == nullptr) cancel(id, {fmt::format("the robot {} was deleted", id), {}});
  }
}

bool MotionService::moving() const {
  return std::ranges::any_of(records_, [](const auto& entry) { return entry.second.pending.in_flight(); });
}

std::optional<JointValues> MotionService::target(std::string_view robot) const {
  const auto found = records_.find(robot);
  if (found == records_.end() || !found->second.goal) return std::nullopt;
  return found->second.goal->joints;
}

Positioning MotionService::positioning(std::string_view robot) const {
  const auto found = records_.find(robot);
  return found == records_.end() ? Positioning::moving : found->second.positioning;
}

Result<ActivityHandle> MotionService::position(std::string_view id, const MotionTarget& target) {
  const RobotModel* robot = cell_.robot(id);
  auto record = open(robot, id);
  if (!record) return std::unexpected(record.error());
  if ((*record)->positioning == Positioning::jumping) {
    auto jumped = jump(*robot, **record, target);
    if (!jumped) return std::unexpected(jumped.error());
    return ActivityHandle();
  }
  auto planned = plan(*robot, **record, path_of(target.mode), target, motion::Start::supersede);
  if (!planned) return std::unexpected(planned.error());
  if (auto sent = send(*robot, **record, std::move(*planned), motion::Start::supersede); !sent)
    return std::unexpected(sent.error());
  return (*record)->pending.watch();
}

Result<void> MotionService::queue_move(std::string_view id, MovePath path, const MotionTarget& target) {
  const RobotModel* robot = cell_.robot(id);
  auto record = open(robot, id);
  if (!record) return std::unexpected(record.error());
  // The one that runs counts too: before the next tick nobody knows whether it has begun, and all of them still wait.
  if ((*record)->pending.count() >= motion::kMoveQueue) {
    return fail(fmt::format("{} moves of {} wait already", motion::kMoveQueue, id),
                "wait until some of them are done, or STOP_ROB forgets them");
  }
  auto planned = plan(*robot, **record, path, target, motion::Start::queue);
  if (!planned) return std::unexpected(planned.error());
  return send(*robot, **record, std::move(*planned), motion::Start::queue);
}

Result<void> MotionService::stop(std::string_view id) {
  const RobotModel* robot = cell_.robot(id);
  auto record = open(robot, id);
  if (!record) return std::unexpected(record.error());
  if (!(*record)->pending.in_flight()) return {};
  (*record)->goal.reset();
  return port_.stop_motion(id);
}

Result<void> MotionService::set_positioning(Positioning positioning) {
  const RobotModel* robot = cell_.robot(names_.active_robot());
  if (robot == nullptr) return fail("no robot is active", "activate one with ROBACT <robot>");
  records_.try_emplace(robot->id(), robot->id()).first->second.positioning = positioning;
  return {};
}

unsigned MotionService::coupled_joints(std::string_view robot) const {
  return coupled_ ? coupled_().coupled_joints(robot) : 0U;
}

MotionGoal MotionService::goal_of(const RobotModel& robot, const MotionRecord& record,
                                  const std::shared_ptr<const kinematics::Chain>& chain) {
  MotionGoal goal = record.goal.value_or(MotionGoal{port_.positions()[robot.slot()], {}, {}});
  // Another tool: the TCP is elsewhere than it was commanded to.
  if (goal.chain != chain) goal.X_ZT.reset();
  const unsigned coupled = coupled_joints(robot.id());
  if (coupled == 0) return goal;
  const JointValues& stands = port_.positions()[robot.slot()];
  for (std::size_t i = 0; i < robot.joint_count(); ++i) {
    if ((coupled >> i & 1U) != 0) goal.joints[i] = stands[i];
  }
  goal.X_ZT.reset();
  return goal;
}

Result<Pose> MotionService::pose_target(const RobotModel& robot, MotionRecord& record, const MotionTarget& target,
                                        const MotionGoal& from) {
  if (planning::is_joint_target(target.mode)) {
    const auto joints = planning::target_joints(robot, target, from.joints);
    if (!joints) return std::unexpected(joints.error());
    return record.kinematics.X_ZT(*joints);
  }
  const Pose X_ZT = from.X_ZT ? *from.X_ZT : record.kinematics.X_ZT(from.joints);
  Eigen::Matrix3d R_ZS = Eigen::Matrix3d::Identity();
  if (target.mode == TargetMode::screen_inc)
    R_ZS = cell_.world_pose(robot.zero_point(), port_.positions()).linear().transpose() * screen_axes_();
  return planning::target_pose(target.mode, target.pose, X_ZT, R_ZS);
}

// Where the joints end when no path is asked for.
Result<MotionGoal> MotionService::point(const RobotModel& robot, MotionRecord& record, const MotionTarget& target,
                                        const MotionGoal& from) {
  if (planning::is_joint_target(target.mode)) {
    auto joints = planning::target_joints(robot, target, from.joints);
    if (!joints) return std::unexpected(joints.error());
    if (auto checked = check_limits(robot, *joints); !checked) return std::unexpected(checked.error());
    return MotionGoal{*joints, {}, record.kinematics.chain()};
  }
  const auto X_ZG = pose_target(robot, record, target, from);
  if (!X_ZG) return std::unexpected(X_ZG.error());
  return planning::reach({robot, record.kinematics, robot.parameters(), clock_}, *X_ZG, from.joints);
}

Result<PlannedMove> MotionService::plan(const RobotModel& robot, MotionRecord& record, MovePath path,
                                        const MotionTarget& target, motion::Start start) {
  if (auto updated = record.kinematics.update(cell_, robot); !updated) return std::unexpected(updated.error());
  const planning::PlanningContext context{robot, record.kinematics, robot.parameters(), clock_};
  const MotionGoal from = goal_of(robot, record, record.kinematics.chain());
  if (path == MovePath::joints) {
    auto goal = point(robot, record, target, from);
    if (!goal) return std::unexpected(goal.error());
    if (auto free = check_coupled(robot, from.joints, goal->joints); !free) return std::unexpected(free.error());
    return planning::plan_joints(context, std::move(*goal));
  }
  if (auto free = check_uncoupled(robot); !free) return std::unexpected(free.error());
  const auto X_ZG = pose_target(robot, record, target, from);
  if (!X_ZG) return std::unexpected(X_ZG.error());
  // A move that takes the place of another one begins on the way.
  const bool on_the_way = start == motion::Start::supersede && record.pending.in_flight();
  return planning::plan_line(context, on_the_way ? port_.positions()[robot.slot()] : from.joints, *X_ZG);
}

Result<void> MotionService::send(const RobotModel& robot, MotionRecord& record, PlannedMove planned,
                                 motion::Start start) {
  if (planned.goal.chain && record.chain_of_tick != planned.goal.chain) {
    if (auto set = port_.set_chain(robot.id(), planned.goal.chain); !set) return set;
    record.chain_of_tick = planned.goal.chain;
  }
  planned.move.start = start;
  planned.move.id = record.pending.next_id();
  if (auto added = port_.add_move(robot.id(), planned.move); !added) return added;
  if (start == motion::Start::supersede) {
    record.pending.superseded_all_by_next();
  } else {
    record.pending.queued_next();
  }
  if (planned.goal.chain) record.goal = std::move(planned.goal);
  return {};
}

Result<void> MotionService::jump(const RobotModel& robot, MotionRecord& record, const MotionTarget& target) {
  if (!planning::is_joint_target(target.mode)) {
    if (auto updated = record.kinematics.update(cell_, robot); !updated) return updated;
  }
  const MotionGoal from = goal_of(robot, record, record.kinematics.chain());
  auto goal = point(robot, record, target, from);
  if (!goal) return std::unexpected(goal.error());
  if (auto free = check_coupled(robot, from.joints, goal->joints); !free) return free;
  if (auto jumped = port_.jump(robot.id(), goal->joints); !jumped) return jumped;
  record.pending.cancel({fmt::format("{} was put elsewhere before it arrived", robot.id()), {}});
  record.goal = std::move(*goal);
  return {};
}

Result<void> MotionService::check_coupled(const RobotModel& robot, const JointValues& from, JointValues& goal) const {
  constexpr double kSame = 1e-6;  // rad or m: as a command's text may round it
  const unsigned coupled = coupled_joints(robot.id());
  for (std::size_t i = 0; coupled != 0 && i < robot.joint_count(); ++i) {
    if ((coupled >> i & 1U) == 0) continue;
    if (std::abs(goal[i] - from[i]) > kSame) {
      return fail(fmt::format("joint {} ({}) of {} follows {}; nothing was moved", i + 1, robot.joints()[i].name,
                              robot.id(), coupled_().master_of(robot.id())),
                  "move the master, or free the joint with MASTER_SLAVE off");
    }
    goal[i] = from[i];
  }
  return {};
}

Result<void> MotionService::check_uncoupled(const RobotModel& robot) const {
  if (coupled_joints(robot.id()) == 0) return {};
  return fail(fmt::format("joints of {} follow {}, so its TCP cannot keep to a line; nothing was moved", robot.id(),
                          coupled_().master_of(robot.id())),
              "move the master, or free the joints with MASTER_SLAVE off");
}

Result<void> MotionService::check_free(const RobotModel& robot) const {
  if (coupled_joints(robot.id()) == 0) return {};
  return fail(
      fmt::format("joints of {} follow {}, so no program can move it", robot.id(), coupled_().master_of(robot.id())),
      "free them with MASTER_SLAVE off");
}

// The tick refuses a posture as a whole, so a joint that was not commanded but stands beyond its limit (the limit was
// narrowed, or the real robot was there) has to be refused here, where the caller gets the answer.
Result<void> MotionService::check_limits(const RobotModel& robot, const JointValues& joints) const {
  const RobotParameters& limits = robot.parameters();
  for (std::size_t i = 0; i < robot.joint_count(); ++i) {
    const engine::LimiterVerdict verdict = engine::check_setpoints(
        std::span(&joints[i], 1), std::span(&limits.min_range[i], 1), std::span(&limits.max_range[i], 1));
    if (verdict == engine::LimiterVerdict::passed) continue;
    const RobotJoint& joint = robot.joints()[i];
    return fail(fmt::format("joint {} ({}) of {} would stand at {}, beyond its limits; nothing was moved", i + 1,
                            joint.name, robot.id(), position_text(joint.kind, joints[i])),
                "choose a target within its range with POS_ROB JOINT_ABS, or widen the range");
  }
  return {};
}

}  // namespace cellmirror::app
