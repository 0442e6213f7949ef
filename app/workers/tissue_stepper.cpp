#include "app/workers/tissue_stepper.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "rt_core/collision/bodies.hpp"

namespace cellmirror::app {

namespace {

// Whether a node is the component of one of the robots, or within it.
bool within_component(const CompiledCell& cell, std::int32_t node, std::span<const std::int32_t> components) {
  for (; node >= 0; node = cell.naming_parent[static_cast<std::size_t>(node)]) {
    if (std::ranges::find(components, node) != components.end()) return true;
  }
  return false;
}

}  // namespace

TissueStepper::TissueStepper(tissue::World world, std::shared_ptr<geometry::SolidLibrary> solids)
    : world_(std::move(world)), solids_(std::move(solids)) {}

// Robots that a device moves, and those of which SCRIPT said how they act on tissue.
void TissueStepper::collect_instruments(const CellState& cell_state) {
  slots_.clear();
  for (const HapticSnapshot& haptic : cell_state.haptics) slots_.push_back(haptic.slot);
  if (settings_) {
    for (const TissueInstrumentSettings& instrument : settings_->instruments) {
      slots_.push_back(static_cast<std::uint8_t>(instrument.slot));
    }
  }
  std::ranges::sort(slots_);
  slots_.erase(std::ranges::unique(slots_).begin(), slots_.end());
  joints_.assign(slots_.size(), JointValues{});
}

// What is rigid and no part of an instrument, whose shape for tissue is that of eladyn_geo_def.
void TissueStepper::collect_obstacles() {
  obstacles_.clear();
  const CompiledCell& cell = *poser_.cell();
  std::vector<std::int32_t> components;
  for (const std::uint8_t slot : slots_) {
    if (const CompiledRobot* robot = cell.robot(slot)) components.push_back(robot->component);
  }
  for (const collision::Body& body : collision::collect_bodies(cell, *solids_).bodies) {
    if (within_component(cell, body.node, components)) continue;
    for (const collision::BodyPart& part : body.parts) obstacles_.push_back({body.node, part.solid, part.X_NG});
  }
}

void TissueStepper::follow(const CellState& cell_state) {
  const bool other_cell = poser_.take_cell(cell_state.cell);
  const std::vector<std::uint8_t> before = slots_;
  settings_ = cell_state.tissue;
  collect_instruments(cell_state);
  if (slots_ != before) ramps_.assign(slots_.size(), PoseRamp());
  if (other_cell || slots_ != before) collect_obstacles();
}

void TissueStepper::pose_instruments(const engine::TickState& tick) {
  instruments_.clear();
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    const CompiledRobot* robot = poser_.cell()->robot(slots_[i]);
    if (robot == nullptr) continue;
    const engine::RobotTickState& state = tick.robots[slots_[i]];
    for (std::size_t j = 0; j < state.joint_count; ++j) joints_[i][j] = state.joints[j].position;
    instruments_.push_back({.slot = slots_[i],
                            .X_WT = ramps_[i].step(tcp_poses(*robot, poser_.poses()).X_WT),
                            .q = std::span(joints_[i]).first(state.joint_count)});
  }
}

void TissueStepper::pose_obstacles() {
  bodies_.clear();
  for (std::uint32_t i = 0; i < obstacles_.size(); ++i) {
    const Obstacle& obstacle = obstacles_[i];
    bodies_.push_back({.id = i,
                       .solid = obstacle.solid.get(),
                       .X_WB = poser_.poses().X_WN[static_cast<std::size_t>(obstacle.node)] * obstacle.X_NG});
  }
}

bool TissueStepper::step(const CellState& cell_state, const engine::TickState& tick) {
  follow(cell_state);
  if (!poser_.take_posture(tick)) return false;
  pose_instruments(tick);
  pose_obstacles();
  world_.step({.time = tick.time, .instruments = instruments_, .bodies = bodies_});
  return true;
}

}  // namespace cellmirror::app
