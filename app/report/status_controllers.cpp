#include "app/report/status_controllers.hpp"

#include <nlohmann/json.hpp>
#include <string>

namespace cellmirror::app {

namespace {

using motion::TrajectoryOutcome;
using nlohmann::json;

const char* outcome_word(TrajectoryOutcome outcome) {
  switch (outcome) {
    case TrajectoryOutcome::none:
      return "none";
    case TrajectoryOutcome::arrived:
      return "arrived";
    case TrajectoryOutcome::superseded:
      return "superseded";
    case TrajectoryOutcome::stopped:
      return "stopped";
    case TrajectoryOutcome::path_tolerance:
      return "path_tolerance";
    case TrajectoryOutcome::goal_tolerance:
      return "goal_tolerance";
    case TrajectoryOutcome::blocked:
      return "blocked";
  }
  return "none";
}

json joints_json(const ControllerSnapshot& controller, const engine::RobotTickState& robot) {
  json joints = json::array();
  for (const ControllerJointSnapshot& joint : controller.joints) {
    const bool given = (robot.trajectory.given >> joint.number & 1U) != 0;
    const double error =
        given ? robot.trajectory.reference[joint.number].position - robot.joints[joint.number].position : 0.0;
    joints.push_back({{"joint", joint.name},
                      {"ros_name", joint.ros_name},
                      {joint.kind == JointKind::prismatic ? "error_m" : "error_rad", error}});
  }
  return joints;
}

json trajectory_json(const ControllerSnapshot& controller, const motion::TrajectoryState& state) {
  if (controller.newest == 0) return nullptr;
  const bool running = state.running == controller.newest;
  const bool ended = state.finished == controller.newest;
  return {{"number", controller.newest},
          {"state", running ? "running"
                    : ended ? outcome_word(state.outcome)
                            : "none"},
          {"elapsed_s", state.elapsed},
          {"duration_s", controller.duration_s},
          {"points", controller.points}};
}

}  // namespace

json controllers_json(std::span<const ControllerSnapshot> controllers, const engine::TickState& tick, Timestamp now) {
  json all = json::array();
  for (const ControllerSnapshot& controller : controllers) {
    const TrajectoryEndpointStatus endpoint = controller.endpoint->status();
    json refusals = json::object();
    for (std::size_t i = 0; i < kTrajectoryRefusals; ++i) {
      if (controller.counts.refused[i] > 0)
        refusals[std::string(words(static_cast<TrajectoryRefusal>(i)))] = controller.counts.refused[i];
    }
    const engine::RobotTickState none;
    const bool known = controller.there && controller.slot < tick.robots.size();
    const engine::RobotTickState& robot = known ? tick.robots[controller.slot] : none;
    json last = nullptr;
    if (!controller.last_refusal.empty())
      last = {{"text", controller.last_refusal}, {"age_s", seconds(now - controller.refused_at)}};
    all.push_back({{"name", "/" + controller.name},
                   {"robot", controller.robot},
                   {"endpoint", endpoint.endpoint},
                   {"publishers", endpoint.publishers},
                   {"messages", endpoint.messages},
                   {"states", {{"sent", endpoint.states}, {"readers", endpoint.state_readers}}},
                   {"action",
                    {{"clients", endpoint.clients},
                     {"taken", controller.goals.taken},
                     {"refused", controller.goals.refused},
                     {"succeeded", controller.goals.succeeded},
                     {"canceled", controller.goals.canceled},
                     {"aborted", controller.goals.aborted},
                     {"feedback_sent", endpoint.feedback},
                     {"bad_requests", endpoint.bad_requests},
                     {"unanswered", endpoint.unanswered}}},
                   {"taken", controller.counts.taken},
                   {"replaced", controller.counts.replaced},
                   {"stops", controller.counts.stops},
                   {"refused", controller.counts.all_refused()},
                   {"refusals", std::move(refusals)},
                   {"last_refusal", std::move(last)},
                   {"trajectory", trajectory_json(controller, robot.trajectory)},
                   {"joints", joints_json(controller, robot)}});
  }
  return all;
}

}  // namespace cellmirror::app
