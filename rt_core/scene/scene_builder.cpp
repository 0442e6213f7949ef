#include "rt_core/scene/scene_builder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>

#include "rt_core/base/contract.hpp"
#include "rt_core/scene/bodies.hpp"
#include "rt_core/scene/cones.hpp"
#include "rt_core/scene/force_arrows.hpp"
#include "rt_core/scene/frames.hpp"
#include "rt_core/scene/ghosts.hpp"
#include "rt_core/scene/legend.hpp"
#include "rt_core/scene/pair_marks.hpp"
#include "rt_core/scene/pyramids.hpp"
#include "rt_core/scene/robot_parts.hpp"
#include "rt_core/scene/tissue.hpp"
#include "rt_core/scene/traces.hpp"
#include "rt_core/scene/volumes.hpp"

namespace cellmirror::scene {

namespace {

constexpr Nanoseconds kMessageTime = std::chrono::seconds(5);      // manual 1.2.6, hot_message
constexpr Nanoseconds kSparkTime = std::chrono::milliseconds(40);  // of one phase
constexpr double kArrowPart = 0.1;                                 // of the cell's diagonal: the longest arrow
constexpr double kShortestArrow = 0.1;                             // m
constexpr double kLongestArrow = 0.8;
constexpr double kFloorMargin = 0.1;  // of the cell's reach
constexpr double kFloorGrid = 0.5;    // m: the floor grows in such steps

void clear(Scene& scene) {
  scene.axes.clear();
  scene.lines.clear();
  scene.traces.clear();
  scene.cones.clear();
  scene.arrows.clear();
  scene.sparks.clear();
  scene.labels.clear();
  scene.legend.clear();
  scene.messages.clear();
}

void draw_sparks(const SceneInput& input, Scene& scene) {
  for (const std::string& id : input.display->arcs) {
    const auto robot = std::ranges::find(input.cell->robots, id, &CompiledRobot::id);
    if (robot == input.cell->robots.end()) continue;
    const auto phase = static_cast<std::uint32_t>(input.now.ns / kSparkTime.count());
    scene.sparks.push_back({tcp_poses(*robot, *input.poses).X_WT.translation(), phase});
  }
}

void write_messages(const SceneInput& input, Scene& scene) {
  for (const ShownText& message : input.display->messages) {
    if (input.now - message.time < kMessageTime) scene.messages.push_back(message.text);
  }
}

void lay_floor(const Bodies& bodies, Scene& scene) {
  scene.floor_z_m = bodies.floor_z();
  scene.shadow_catchers = bodies.slabs();
  if (bodies.reach().isEmpty()) return;
  const Eigen::Vector2d margin = kFloorMargin * bodies.reach().sizes().head<2>();
  const auto on_grid = [](double value, auto round) { return kFloorGrid * round(value / kFloorGrid); };
  const Eigen::Vector2d low = bodies.reach().min().head<2>() - margin;
  const Eigen::Vector2d high = bodies.reach().max().head<2>() + margin;
  scene.floor_low = low.unaryExpr([&](double value) { return on_grid(value, [](double x) { return std::floor(x); }); });
  scene.floor_high =
      high.unaryExpr([&](double value) { return on_grid(value, [](double x) { return std::ceil(x); }); });
}

double longest_arrow(const Bodies& bodies) {
  if (bodies.reach().isEmpty()) return kShortestArrow;
  return std::clamp(kArrowPart * bodies.reach().sizes().norm(), kShortestArrow, kLongestArrow);
}

}  // namespace

struct SceneBuilder::Parts {
  Bodies bodies;
  RobotParts robots;
  PairMarks pairs;
  ForceArrows arrows;
  TissueMarks tissue;
};

SceneBuilder::SceneBuilder() : parts_(std::make_unique<Parts>()) {}
SceneBuilder::~SceneBuilder() = default;

void SceneBuilder::build(const SceneInput& input, Scene& scene) {
  CELLMIRROR_EXPECTS(input.cell != nullptr && input.poses != nullptr && input.display != nullptr);
  CELLMIRROR_EXPECTS(input.poses->X_WN.size() == input.cell->size());
  Parts& parts = *parts_;
  clear(scene);
  scene.posture_time = input.posture_time;
  scene.modes = input.display->modes;
  if (parts.bodies.update(*input.cell, *input.poses, input.display->draw_rules)) {
    parts.robots.update(*input.cell);
    parts.pairs.update(*input.cell, parts.bodies);
  }
  parts.bodies.place(*input.poses, scene.bodies);
  mark_ghosts(*input.cell, input.robots, parts.bodies, parts.robots, scene);
  if (input.proximity != nullptr) parts.pairs.draw(*input.proximity, input.now, parts.bodies, scene);
  draw_frames(input, scene);
  draw_traces(input, scene);
  draw_cones(input, scene);
  draw_beams(input, scene);
  parts.arrows.draw(input.arrows, longest_arrow(parts.bodies), scene);
  place_volumes(input, scene);
  parts.tissue.draw(input.tissue, input.display->draw_rules, scene);
  if (input.forces != nullptr) label_overloads(*input.forces, scene);
  draw_pyramids(input, scene);
  draw_sparks(input, scene);
  write_messages(input, scene);
  lay_floor(parts.bodies, scene);
  write_legend(input, parts.arrows, parts.tissue, scene);
}

}  // namespace cellmirror::scene
