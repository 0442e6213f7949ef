#include "app/owner/controllers/controller_service.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rt_core/base/log.hpp"

namespace cellmirror::app {

namespace {

// control_msgs/action/FollowJointTrajectory.
constexpr std::int32_t kSuccessful = 0;
constexpr std::int32_t kInvalidGoal = -1;
constexpr std::int32_t kInvalidJoints = -2;
constexpr std::int32_t kOldHeaderTimestamp = -3;
constexpr std::int32_t kPathToleranceViolated = -4;
constexpr std::int32_t kGoalToleranceViolated = -5;

std::int32_t error_code_of(TrajectoryRefusal refusal) {
  if (refusal == TrajectoryRefusal::joints) return kInvalidJoints;
  return refusal == TrajectoryRefusal::past ? kOldHeaderTimestamp : kInvalidGoal;
}

constexpr Nanoseconds kLongestWait{3'600'000'000'000};  // for a start that has not come

planning::TrajectoryController plan_of(const ControllerConfig& config) {
  planning::TrajectoryController out;
  out.goal_time = config.goal_time;
  out.allow_partial = config.allow_partial;
  for (const ControllerJoint& joint : config.joints)
    out.joints.push_back(
        {joint.joint, joint.ros_name, joint.path_tolerance, joint.goal_tolerance, config.stopped_velocity});
  return out;
}

}  // namespace

ControllerService::ControllerService(Parts parts) : parts_(std::move(parts)) {}

ControllerService::~ControllerService() {
  for (Controller& one : controllers_) one.endpoint->close();
}

Result<void> ControllerService::prepare() {
  for (const ControllerConfig& config : parts_.controllers) {
    auto endpoint = parts_.make_endpoint(config);
    if (!endpoint) return std::unexpected(endpoint.error());
    Controller one{.config = config,
                   .plan = plan_of(config),
                   .endpoint = std::move(*endpoint),
                   .inbox = std::make_unique<TrajectoryInbox>(parts_.wake)};
    if (auto opened = one.endpoint->open(*one.inbox); !opened) return opened;
    controllers_.push_back(std::move(one));
  }
  return {};
}

bool ControllerService::follow() {
  bool changed = false;
  for (Controller& one : controllers_) changed = follow(one) || changed;
  return changed;
}

bool ControllerService::follow(Controller& controller) {
  bool changed = watch(controller);
  for (std::size_t i = 0; i < 2 * TrajectoryInbox::kMostWaiting; ++i) {
    const auto message = controller.inbox->take();
    if (!message) break;
    take(controller, *message);
    changed = true;
  }
  const TrajectoryInbox::Dropped dropped = controller.inbox->take_dropped();
  for (std::size_t i = 0; i < dropped.count; ++i) refuse(controller, TrajectoryRefusal::busy, "too many wait");
  for (const GoalId& goal : dropped.goals) {
    ++controller.goals.refused;
    controller.endpoint->answer(goal, false);
  }
  return changed || dropped.count > 0;
}

void ControllerService::refuse(Controller& controller, TrajectoryRefusal refusal, const std::string& why) {
  ++controller.counts.refused[static_cast<std::size_t>(refusal)];
  controller.last_refusal = fmt::format("{}: {}", words(refusal), why);
  controller.refused_at = parts_.clock.now();
  log_warning("controller.refused", "a trajectory for {} was refused ({})", controller.config.name,
              controller.last_refusal);
}

void ControllerService::take(Controller& controller, const TrajectoryMessage& message) {
  if (message.refused) return refuse(controller, *message.refused, message.why);
  if (message.goal) return take_goal(controller, message);
  const bool is_stop = message.cancel || message.trajectory.points.empty();
  if (!is_stop) {
    if (const auto fault = start(controller, message.trajectory, nullptr))
      refuse(controller, fault->refusal, fault->text);
    return;
  }
  if (message.cancel && message.cancel != controller.goal) return;  // it has just ended
  if (message.cancel) {
    controller.canceled = true;
  } else {
    ++controller.counts.stops;
  }
  if (auto stopped = stop(controller.config.robot); !stopped)
    refuse(controller, TrajectoryRefusal::failed, stopped.error().text());
}

// A goal is refused while the robot cannot be moved at all; what is wrong with the goal itself is its result, since a
// refusal has no words.
void ControllerService::take_goal(Controller& controller, const TrajectoryMessage& message) {
  const GoalId& id = message.goal->id;
  if (const auto fault = check_free(controller)) {
    refuse(controller, fault->refusal, fault->text);
    ++controller.goals.refused;
    return controller.endpoint->answer(id, false);
  }
  std::optional<planning::TrajectoryFault> fault;
  if (message.trajectory.points.empty()) {
    fault = {TrajectoryRefusal::sizes, "the trajectory has no points"};
  } else {
    fault = start(controller, message.trajectory, &*message.goal);
  }
  ++controller.goals.taken;
  controller.endpoint->answer(id, true);
  if (!fault) {
    controller.goal = id;
    controller.canceled = false;
    return;
  }
  refuse(controller, fault->refusal, fault->text);
  ++controller.goals.aborted;
  controller.endpoint->finish(id, {GoalEnd::aborted, error_code_of(fault->refusal), fault->text});
}

void ControllerService::end_goal(Controller& controller, const GoalResult& result) {
  if (!controller.goal) return;
  std::uint64_t& count = result.end == GoalEnd::succeeded  ? controller.goals.succeeded
                         : result.end == GoalEnd::canceled ? controller.goals.canceled
                                                           : controller.goals.aborted;
  ++count;
  controller.endpoint->finish(*controller.goal, result);
  controller.goal.reset();
}

void ControllerService::end_goal(Controller& controller, const motion::TrajectoryState& state) {
  using motion::TrajectoryOutcome;
  if (!controller.goal) return;
  const auto joint = std::ranges::find(controller.config.joints, std::size_t{state.joint}, &ControllerJoint::joint);
  const std::string name = joint == controller.config.joints.end() ? std::string() : joint->ros_name;
  switch (state.outcome) {
    case TrajectoryOutcome::arrived:
      return end_goal(controller, {GoalEnd::succeeded, kSuccessful, {}});
    case TrajectoryOutcome::path_tolerance:
      return end_goal(controller, {GoalEnd::aborted, kPathToleranceViolated,
                                   fmt::format("{} was {:.6g} off its path", name, state.deviation)});
    case TrajectoryOutcome::goal_tolerance:
      return end_goal(controller, {GoalEnd::aborted, kGoalToleranceViolated,
                                   fmt::format("{} was {:.6g} off its goal, or still moved, when its time was over",
                                               name, state.deviation)});
    case TrajectoryOutcome::none:
    case TrajectoryOutcome::superseded:
      return end_goal(controller, {GoalEnd::canceled, kSuccessful, "another motion took its place"});
    case TrajectoryOutcome::stopped:
      if (controller.canceled) return end_goal(controller, {GoalEnd::canceled, kSuccessful, {}});
      return end_goal(controller, {GoalEnd::aborted, kInvalidGoal, "the robot was stopped"});
    case TrajectoryOutcome::blocked:
      return end_goal(controller, {GoalEnd::aborted, kInvalidGoal, "the robot's limits did not let it go on"});
  }
}

std::optional<planning::TrajectoryFault> ControllerService::check_free(const Controller& controller) const {
  const std::string& robot = controller.config.robot;
  using planning::TrajectoryFault;
  if (parts_.cell.robot(robot) == nullptr)
    return TrajectoryFault{TrajectoryRefusal::failed, fmt::format("the cell has no robot {} now", robot)};
  if (auto simulated = parts_.fleet.check_simulated(robot); !simulated)
    return TrajectoryFault{TrajectoryRefusal::mirrored, simulated.error().text()};
  if (const std::string program = parts_.moving_program(robot); !program.empty())
    return TrajectoryFault{TrajectoryRefusal::busy, fmt::format("the robot program {} moves {}", program, robot)};
  if (parts_.coupled.coupled_joints(robot) != 0)
    return TrajectoryFault{TrajectoryRefusal::busy,
                           fmt::format("joints of {} follow {}", robot, parts_.coupled.master_of(robot))};
  return std::nullopt;
}

std::optional<planning::TrajectoryFault> ControllerService::start(Controller& controller,
                                                                  const JointTrajectory& message,
                                                                  const TrajectoryGoal* goal) {
  using planning::TrajectoryFault;
  const std::string& robot = controller.config.robot;
  if (auto fault = check_free(controller)) return fault;
  const RobotModel& model = *parts_.cell.robot(robot);
  planning::TrajectoryTimes times{.now = parts_.clock.now()};
  if (message.start_wall_ns) {
    times.start = from_wall_clock_ns(*message.start_wall_ns);
    if (!times.start.known()) return TrajectoryFault{TrajectoryRefusal::past, "it begins before this machine's start"};
    if (times.start - times.now > kLongestWait)
      return TrajectoryFault{TrajectoryRefusal::times, fmt::format("it begins in {:.0f} s, at most an hour is waited",
                                                                   seconds(times.start - times.now))};
  }
  auto planned =
      planning::plan_trajectory(controller.plan, {model.joint_kinds(), model.parameters()}, message, goal, times);
  if (!planned) return planned.error();
  planned->id = controller.newest + 1;
  const double duration_s = planned->duration();
  const auto sent =
      parts_.fleet.follow_trajectory(robot, std::make_shared<const motion::Trajectory>(*std::move(planned)));
  if (!sent) return TrajectoryFault{TrajectoryRefusal::failed, sent.error().text()};
  parts_.motion.cancel(robot, {fmt::format("a trajectory of the controller {} took its place", controller.config.name),
                               "wait until it has ended, or end it with STOP_ROB"});
  if (controller.ended < controller.newest) ++controller.counts.replaced;
  end_goal(controller, {GoalEnd::canceled, kSuccessful, "a newer trajectory took its place"});
  controller.ended = controller.newest;
  ++controller.newest;
  controller.newest_command = *sent;
  controller.duration_s = duration_s;
  controller.points = message.points.size();
  ++controller.counts.taken;
  return std::nullopt;
}

// True where its trajectory has ended.
bool ControllerService::watch(Controller& controller) {
  if (controller.ended == controller.newest) return false;
  const RobotModel* model = parts_.cell.robot(controller.config.robot);
  if (model == nullptr) {
    controller.ended = controller.newest;
    end_goal(controller, {GoalEnd::aborted, kInvalidGoal, "the robot was deleted"});
    return true;
  }
  const engine::TickState& tick = parts_.fleet.tick();
  if (tick.commands_done < controller.newest_command) return false;
  const motion::TrajectoryState& state = tick.robots[model->slot()].trajectory;
  if (state.running == controller.newest) return false;
  controller.ended = controller.newest;
  if (state.finished == controller.newest) {
    end_goal(controller, state);
  } else {
    refuse(controller, TrajectoryRefusal::failed, "the loop did not take it, since the robot was not free");
    end_goal(controller, {GoalEnd::aborted, kInvalidGoal, "the robot was not free"});
  }
  return true;
}

bool ControllerService::moving() const {
  return std::ranges::any_of(controllers_, [](const Controller& one) { return one.ended < one.newest; });
}

std::string_view ControllerService::moving_controller(std::string_view robot) const {
  const auto found = std::ranges::find_if(
      controllers_, [robot](const Controller& one) { return one.config.robot == robot && one.ended < one.newest; });
  return found == controllers_.end() ? std::string_view() : std::string_view(found->config.name);
}

Result<void> ControllerService::stop(std::string_view robot) {
  if (moving_controller(robot).empty()) return {};
  return parts_.fleet.stop_motion(robot);
}

std::vector<ControllerSnapshot> ControllerService::snapshots() const {
  std::vector<ControllerSnapshot> all;
  for (const Controller& one : controllers_) {
    const RobotModel* model = parts_.cell.robot(one.config.robot);
    ControllerSnapshot snapshot{.name = one.config.name,
                                .robot = one.config.robot,
                                .slot = model == nullptr ? 0 : model->slot(),
                                .there = model != nullptr,
                                .joints = {},
                                .endpoint = one.endpoint,
                                .period = one.config.state_rate_hz > 0
                                              ? Nanoseconds(static_cast<std::int64_t>(1e9 / one.config.state_rate_hz))
                                              : Nanoseconds(0),
                                .counts = one.counts,
                                .goals = one.goals,
                                .newest = one.newest,
                                .duration_s = one.duration_s,
                                .points = one.points,
                                .last_refusal = one.last_refusal,
                                .refused_at = one.refused_at};
    for (const ControllerJoint& joint : one.config.joints) {
      if (model == nullptr || joint.joint >= model->joint_count()) continue;
      const RobotJoint& of_robot = model->joints()[joint.joint];
      snapshot.joints.push_back({joint.joint, of_robot.name, joint.ros_name, of_robot.kind});
    }
    all.push_back(std::move(snapshot));
  }
  return all;
}

}  // namespace cellmirror::app
