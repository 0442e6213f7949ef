#include "rt_core/scene/pyramids.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "rt_core/ports/palette.hpp"
#include "rt_core/scene/cameras.hpp"
#include "rt_core/scene/paths.hpp"

namespace cellmirror::scene {

namespace {

constexpr double kAspect = 4.0 / 3.0;

void draw_line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, bool dashed, Scene& scene) {
  scene.lines.push_back({.from = from, .to = to, .rgba = palette::kPyramid, .dashed = dashed});
}

void draw_pyramid(const CameraNow& camera, Scene& scene) {
  const double distance = camera.focal_distance_m;
  const double half_height = distance * std::tan(0.5 * camera.fovy_rad);
  const double half_width = kAspect * half_height;
  const Eigen::Vector3d apex = camera.X_WC.translation();
  const std::array<Eigen::Vector3d, 4> corners = {camera.X_WC * Eigen::Vector3d(-half_width, -half_height, distance),
                                                  camera.X_WC * Eigen::Vector3d(half_width, -half_height, distance),
                                                  camera.X_WC * Eigen::Vector3d(half_width, half_height, distance),
                                                  camera.X_WC * Eigen::Vector3d(-half_width, half_height, distance)};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    draw_line(apex, corners[i], false, scene);
    draw_line(corners[i], corners[(i + 1) % corners.size()], false, scene);
  }
  // Which side is up: a mark over the middle of the upper edge.
  const Eigen::Vector3d up = camera.X_WC * Eigen::Vector3d(0, -1.15 * half_height, distance);
  draw_line(0.75 * corners[0] + 0.25 * corners[1], up, false, scene);
  draw_line(0.25 * corners[0] + 0.75 * corners[1], up, false, scene);
}

}  // namespace

void draw_pyramids(const SceneInput& input, Scene& scene) {
  const CompiledCell& cell = *input.cell;
  for (const CameraSetting& setting : input.display->cameras) {
    if (!setting.pyramid) continue;
    const auto camera = camera_now(cell, *input.poses, *input.display, setting.name);
    if (!camera || cell.visible[static_cast<std::size_t>(cell.cameras[camera->camera].node)] == 0) continue;
    draw_pyramid(*camera, scene);
    const Eigen::Vector3d apex = camera->X_WC.translation();
    // A mirrored head may not have turned there yet.
    if (const auto target = camera->tracking ? node_at(cell, setting.tracks) : std::nullopt)
      draw_line(apex, input.poses->X_WN[static_cast<std::size_t>(*target)].translation(), true, scene);
    // Its workframe carries the name already.
    if (!input.display->on(DisplayMode::workframes))
      scene.labels.push_back({apex, cell.cameras[camera->camera].name, Mark::none});
  }
}

}  // namespace cellmirror::scene
