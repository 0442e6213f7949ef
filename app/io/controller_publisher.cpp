#include "app/io/controller_publisher.hpp"

#include <algorithm>

namespace cellmirror::app {

namespace {

// A joint that is on no trajectory wants to be where it is.
void fill(const ControllerSnapshot& controller, const engine::TickState& tick, ControllerState& out) {
  const engine::RobotTickState& robot = tick.robots[controller.slot];
  out.time = tick.time;
  out.reference.clear();
  out.feedback.clear();
  out.elapsed = robot.trajectory.moving ? robot.trajectory.elapsed : 0.0;
  out.point = static_cast<std::int32_t>(robot.trajectory.point);
  for (const ControllerJointSnapshot& joint : controller.joints) {
    const engine::JointTickState& is = robot.joints[joint.number];
    const AxisState state{is.position, is.velocity, 0};
    const bool wanted = robot.trajectory.moving && (robot.trajectory.given >> joint.number & 1U) != 0;
    out.feedback.push_back(state);
    out.reference.push_back(wanted ? robot.trajectory.reference[joint.number] : state);
  }
}

bool publishes(const ControllerSnapshot& controller) { return controller.there && controller.period > Nanoseconds(0); }

}  // namespace

bool ControllerPublisher::due(const CellState& cell_state, Timestamp by) const {
  const Timestamp first = next(cell_state);
  return first.known() && first <= by;
}

Timestamp ControllerPublisher::next(const CellState& cell_state) const {
  Timestamp first;
  for (const ControllerSnapshot& controller : cell_state.controllers) {
    if (!publishes(controller)) continue;
    const auto known = due_.find(controller.name);
    const Timestamp one = known == due_.end() ? Timestamp{1} : known->second;
    first = first.known() ? std::min(first, one) : one;
  }
  return first;
}

void ControllerPublisher::publish(const CellState& cell_state, const engine::TickState& tick, Timestamp now,
                                  Timestamp by) {
  for (const ControllerSnapshot& controller : cell_state.controllers) {
    if (!publishes(controller) || controller.slot >= tick.robots.size()) continue;
    Timestamp& due = due_[controller.name];
    due = std::min(due, now + controller.period);  // the time may have been set back
    if (due > by) continue;
    fill(controller, tick, state_);
    controller.endpoint->publish(state_);
    due = std::max(due + controller.period, now);  // it may have been late by more than a period
  }
}

}  // namespace cellmirror::app
