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

// Lines of a camera are across its own picture: they are left out there.
struct Lines {
  Scene& scene;
  std::uint32_t camera = 0;
  void draw(const Eigen::Vector3d& from, const Eigen::Vector3d& to, bool dashed) const {
    scene.lines.push_back({.from = from, .to = to, .rgba = palette::kPyramid, .dashed = dashed, .camera = camera});
  }
};

void draw_pyramid(const CameraNow& camera, const Lines& lines) {
  const double distance = camera.focal_distance_m;
  const double half_height = distance * std::tan(0.5 * camera.fovy_rad);
  const double half_width = kAspect * half_height;
  const Eigen::Vector3d apex = camera.X_WC.translation();
  const std::array<Eigen::Vector3d, 4> corners = {camera.X_WC * Eigen::Vector3d(-half_width, -half_height, distance),
                                                  camera.X_WC * Eigen::Vector3d(half_width, -half_height, distance),
                                                  camera.X_WC * Eigen::Vector3d(half_width, half_height, distance),
                                                  camera.X_WC * Eigen::Vector3d(-half_width, half_height, distance)};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    lines.draw(apex, corners[i], false);
    lines.draw(corners[i], corners[(i + 1) % corners.size()], false);
  }
  // Which side is up: a mark over the middle of the upper edge.
  const Eigen::Vector3d up = camera.X_WC * Eigen::Vector3d(0, -1.15 * half_height, distance);
  lines.draw(0.75 * corners[0] + 0.25 * corners[1], up, false);
  lines.draw(0.25 * corners[0] + 0.75 * corners[1], up, false);
}

}  // namespace

void draw_pyramids(const SceneInput& input, Scene& scene) {
  const CompiledCell& cell = *input.cell;
  for (const CameraSetting& setting : input.display->cameras) {
    if (!setting.pyramid) continue;
    const auto camera = camera_now(cell, *input.poses, *input.display, setting.name);
    if (!camera || cell.visible[static_cast<std::size_t>(cell.cameras[camera->camera].node)] == 0) continue;
    const Lines lines{scene, object_of_camera(cell, *camera)};
    draw_pyramid(*camera, lines);
    const Eigen::Vector3d apex = camera->X_WC.translation();
    // A mirrored head may not have turned there yet.
    if (const auto target = camera->tracking ? node_at(cell, setting.tracks) : std::nullopt)
      lines.draw(apex, input.poses->X_WN[static_cast<std::size_t>(*target)].translation(), true);
    // Its workframe carries the name already.
    if (!input.display->on(DisplayMode::workframes))
      scene.labels.push_back({apex, cell.cameras[camera->camera].name, Mark::none, lines.camera});
  }
}

}  // namespace cellmirror::scene
