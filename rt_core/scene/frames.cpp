#include "rt_core/scene/frames.hpp"

#include <algorithm>
#include <string>

#include "rt_core/scene/paths.hpp"

namespace cellmirror::scene {

namespace {

const Pose& pose_of(const SceneInput& input, std::int32_t node) {
  return input.poses->X_WN[static_cast<std::size_t>(node)];
}

void draw_workframes(const SceneInput& input, Scene& scene) {
  const CompiledCell& cell = *input.cell;
  const auto draw = [&](std::int32_t node) {
    if (cell.visible[static_cast<std::size_t>(node)] == 0) return;
    SceneAxes axes;
    axes.X_WF = pose_of(input, node);
    axes.length_m = input.display->tag_length_m;
    axes.name = last_name(path_of(cell, node));
    scene.axes.push_back(std::move(axes));
  };
  std::ranges::for_each(cell.workframes, draw);
  for (const CompiledCamera& camera : cell.cameras) draw(camera.node);
  for (const CompiledSensor& sensor : cell.sensors) draw(sensor.node);
}

SceneAxes emphasized(const SceneInput& input, const Pose& X_WF, std::string name) {
  return {.X_WF = X_WF, .length_m = input.display->tag_length_m, .emphasized = true, .name = std::move(name)};
}

}  // namespace

const CompiledRobot* active_robot(const SceneInput& input) {
  const auto at = std::ranges::find(input.cell->robots, input.active_robot, &CompiledRobot::id);
  return at == input.cell->robots.end() ? nullptr : &*at;
}

void draw_frames(const SceneInput& input, Scene& scene) {
  if (input.display->on(DisplayMode::workframes)) draw_workframes(input, scene);
  const CompiledRobot* robot = active_robot(input);
  if (robot == nullptr) return;
  if (input.display->on(DisplayMode::tcp_frame))
    scene.axes.push_back(emphasized(input, tcp_poses(*robot, *input.poses).X_WT, robot->id + " TCP"));
  if (input.display->on(DisplayMode::zero_point_frame))
    scene.axes.push_back(emphasized(input, pose_of(input, robot->zero_point), robot->id + " ZP"));
}

}  // namespace cellmirror::scene
