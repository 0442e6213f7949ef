#include "app/playback/tick_publication.hpp"

#include <algorithm>

namespace cellmirror::app {

namespace {

engine::RobotTickState at_rest(const RobotSnapshot& robot, std::size_t joints, Timestamp now) {
  engine::RobotTickState out;
  out.mode = engine::RobotMode::simulated;
  out.joint_count = static_cast<std::uint8_t>(joints);
  out.state = DataState::fresh;
  for (std::size_t i = 0; i < joints; ++i) {
    out.joints.at(i).position = robot.parameters.start_position.at(i);
    out.joints.at(i).receive_time = now;
    out.joints.at(i).state = DataState::fresh;
  }
  return out;
}

}  // namespace

void TickPublication::match(const CellState& cell_state, const NamesBySlot& names) {
  matches_.clear();
  missing_.clear();
  for (const CompiledRobot& robot : cell_state.cell->robots) {
    const auto found = std::ranges::find_if(
        names, [&](const auto& one) { return one.second.robot == robot.id && one.second.joints == robot.joint_names; });
    if (found == names.end()) {
      missing_.push_back(robot.id);
    } else {
      matches_.push_back({.recorded = found->first, .slot = robot.slot});
    }
  }
}

void TickPublication::publish(const engine::TickState& recorded, const NamesBySlot& names, std::uint64_t revision) {
  const std::shared_ptr<const CellState> cell_state = board_.latest();
  if (cell_state->cell != cell_ || revision != revision_) {
    match(*cell_state, names);
    cell_ = cell_state->cell;
    revision_ = revision;
  }
  const auto slot_of = [&](std::size_t slot) {
    const auto found = std::ranges::find(matches_, slot, &Match::recorded);
    return static_cast<std::uint8_t>(found == matches_.end() ? slot : found->slot);
  };
  engine::TickState& out = states_.writable();
  out.tick = recorded.tick;
  out.time = recorded.time;
  out.missed_periods = recorded.missed_periods;
  out.commands_done = recorded.commands_done;
  out.commands_refused = recorded.commands_refused;
  out.haptics = recorded.haptics;
  for (HapticState& haptic : out.haptics) haptic.slot = slot_of(haptic.slot);
  for (engine::RobotTickState& robot : out.robots) robot.mode = engine::RobotMode::absent;
  for (const Match& one : matches_) {
    if (one.recorded >= recorded.robots.size() || one.slot >= out.robots.size()) continue;
    out.robots[one.slot] = recorded.robots[one.recorded];
    out.robots[one.slot].follow.master = slot_of(out.robots[one.slot].follow.master);
  }
  for (const RobotSnapshot& robot : cell_state->robots) {
    if (robot.slot >= out.robots.size() || out.robots[robot.slot].mode != engine::RobotMode::absent) continue;
    const CompiledRobot* const compiled = cell_state->cell->robot(robot.slot);
    if (compiled != nullptr) out.robots[robot.slot] = at_rest(robot, compiled->joint_names.size(), recorded.time);
  }
  states_.publish();
}

}  // namespace cellmirror::app
