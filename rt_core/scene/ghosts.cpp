#include "rt_core/scene/ghosts.hpp"

#include <fmt/format.h>

#include "rt_core/scene/words.hpp"

namespace cellmirror::scene {

namespace {

constexpr double kAbove = 0.06;  // of the robot's diagonal

bool is_ghost(const RobotCondition& robot) { return robot.mirrored && robot.state != DataState::fresh; }

std::string text_of(const CompiledRobot& robot, const RobotCondition& condition) {
  if (condition.state == DataState::none) return fmt::format("{}: no data", robot.id);
  return fmt::format("{}: {} {}", robot.id, state_text(condition.state), age_text(condition.age_s));
}

// Over the middle of the robot's own bodies.
Eigen::Vector3d place_of_label(const CompiledRobot& robot, const Bodies& bodies, const RobotParts& parts,
                               const Scene& scene) {
  Box box;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (parts.part_of(bodies.node(i)) == static_cast<int>(robot.slot))
      box.extend(moved(scene.bodies[i].X_WG, bodies.bounds(i)));
  }
  if (box.isEmpty()) return Eigen::Vector3d::Zero();
  return {box.center().x(), box.center().y(), box.max().z() + kAbove * box.sizes().norm()};
}

}  // namespace

RobotSet ghosts_of(std::span<const RobotCondition> robots) {
  RobotSet ghosts;
  for (const RobotCondition& robot : robots) {
    if (is_ghost(robot) && robot.slot < kMaxRobots) ghosts.set(robot.slot);
  }
  return ghosts;
}

void mark_ghosts(const CompiledCell& cell, std::span<const RobotCondition> robots, const Bodies& bodies,
                 const RobotParts& parts, Scene& scene) {
  const RobotSet ghosts = ghosts_of(robots);
  if (ghosts.none()) return;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if ((parts.decide(bodies.node(i)) & ghosts).none()) continue;
    scene.bodies[i].mark = Mark::ghost;
    scene.bodies[i].casts_shadow = false;
  }
  for (const RobotCondition& condition : robots) {
    const CompiledRobot* robot = cell.robot(condition.slot);
    if (!is_ghost(condition) || robot == nullptr) continue;
    scene.labels.push_back({place_of_label(*robot, bodies, parts, scene), text_of(*robot, condition), Mark::ghost});
  }
}

}  // namespace cellmirror::scene
