#include "app/snapshot/cell_poser.hpp"

#include <algorithm>

namespace cellmirror::app {

namespace {

bool same(const CompiledJoint& a, const CompiledJoint& b) {
  return a.axis == b.axis && a.multiplier == b.multiplier && a.offset == b.offset && a.kind == b.kind &&
         a.slot == b.slot && a.joint == b.joint;
}

// But for the tool centre point.
bool same(const CompiledRobot& a, const CompiledRobot& b) {
  return a.id == b.id && a.slot == b.slot && a.joint_nodes == b.joint_nodes && a.base == b.base &&
         a.flange == b.flange && a.component == b.component && a.min_range == b.min_range &&
         a.max_range == b.max_range && a.start_position == b.start_position;
}

bool same(const CompiledGeometry& a, const CompiledGeometry& b) { return a.node == b.node && a.geometry == b.geometry; }

bool same(const CompiledSensor& a, const CompiledSensor& b) {
  const SensorDefinition& x = a.sensor;
  const SensorDefinition& y = b.sensor;
  return a.name == b.name && a.node == b.node && x.range_m == y.range_m && x.half_angle_rad == y.half_angle_rad &&
         x.blind_zone_m == y.blind_zone_m && x.active == y.active && x.max_incidence_rad == y.max_incidence_rad &&
         x.noise_m == y.noise_m && x.seed == y.seed;
}

bool same(const Pose& a, const Pose& b) { return a.matrix() == b.matrix(); }

template <class List>
bool all_same(const List& a, const List& b) {
  return std::ranges::equal(a, b, [](const auto& x, const auto& y) { return same(x, y); });
}

}  // namespace

bool same_bodies(const CompiledCell& a, const CompiledCell& b, bool sensors) {
  if (&a == &b) return true;
  return a.paths == b.paths && a.parent == b.parent && a.naming_parent == b.naming_parent && a.joint_of == b.joint_of &&
         a.visible == b.visible && all_same(a.geometry, b.geometry) && all_same(a.robots, b.robots) &&
         all_same(a.joints, b.joints) && all_same(a.X_PF, b.X_PF) && (!sensors || all_same(a.sensors, b.sensors));
}

bool same_tool_points(const CompiledCell& a, const CompiledCell& b) {
  return std::ranges::equal(a.robots, b.robots, [](const CompiledRobot& x, const CompiledRobot& y) {
    return x.slot == y.slot && same(x.X_FT, y.X_FT);
  });
}

bool CellPoser::differs(const std::shared_ptr<const CompiledCell>& cell) const {
  if (cell == newest_) return false;
  return !cell_ || !same_bodies(*cell_, *cell, sensors_) || (tool_points_ && !same_tool_points(*cell_, *cell));
}

bool CellPoser::take_cell(const std::shared_ptr<const CompiledCell>& cell) {
  const bool news = differs(cell);
  newest_ = cell;
  if (!news) return false;
  cell_ = cell;
  poser_.reserve(cell->size());
  later_.reserve(cell->size());
  return true;
}

const CellPoses* CellPoser::later(const engine::TickState& tick, Nanoseconds ahead) {
  bool moves = false;
  for (const CompiledRobot& robot : cell_->robots) {
    const engine::RobotTickState& from = tick.robots[robot.slot];
    const bool known = from.mode == engine::RobotMode::simulated || from.state == DataState::fresh;
    for (std::size_t i = 0; i < from.joint_count; ++i) {
      const double step = known ? from.joints[i].velocity * seconds(ahead) : 0.0;
      later_positions_[robot.slot][i] = poser_.positions()[robot.slot][i] + step;
      moves = moves || step != 0.0;
    }
  }
  if (!moves) return nullptr;
  compute_poses(*cell_, later_positions_, later_);
  return &later_;
}

}  // namespace cellmirror::app
