#include "rt_core/scene/cameras.hpp"

#include <algorithm>
#include <cstddef>

#include "rt_core/ports/camera_state.hpp"
#include "rt_core/scene/camera_mount.hpp"
#include "rt_core/scene/paths.hpp"

namespace cellmirror::scene {

namespace {

const CameraSetting* setting_of(const CompiledCell& cell, const DisplayState& display, const CompiledCamera& camera) {
  const auto at = std::ranges::find_if(
      display.cameras, [&](const CameraSetting& setting) { return names_node(cell, setting.name, camera.node); });
  return at == display.cameras.end() ? nullptr : &*at;
}

CameraNow now_of(const CompiledCell& cell, const CellPoses& poses, const DisplayState& display, std::size_t index) {
  const CompiledCamera& camera = cell.cameras[index];
  CameraNow now;
  now.camera = index;
  now.X_WC = poses.X_WN[static_cast<std::size_t>(camera.node)];
  now.focal_distance_m = camera.focal_distance_m;
  now.fovy_rad = camera.fovy_rad;
  const CameraSetting* setting = setting_of(cell, display, camera);
  if (setting == nullptr || setting->tracks.empty()) return now;
  const CameraState state = camera_state(cell, poses, *setting, index);
  if (!state.tracking) return now;
  now.tracking = true;
  now.focal_distance_m = state.focal_distance_m;
  if (setting->mirrored) return now;
  now.X_WC = state.X_WC;
  now.pan_rad = state.pan_rad;
  now.tilt_rad = state.tilt_rad;
  return now;
}

}  // namespace

std::optional<CameraNow> camera_now(const CompiledCell& cell, const CellPoses& poses, const DisplayState& display,
                                    std::string_view name) {
  for (std::size_t i = 0; i < cell.cameras.size(); ++i) {
    if (names_node(cell, name, cell.cameras[i].node)) return now_of(cell, poses, display, i);
  }
  return std::nullopt;
}

std::vector<CameraNow> cameras_now(const CompiledCell& cell, const CellPoses& poses, const DisplayState& display) {
  std::vector<CameraNow> cameras;
  cameras.reserve(cell.cameras.size());
  for (std::size_t i = 0; i < cell.cameras.size(); ++i) cameras.push_back(now_of(cell, poses, display, i));
  return cameras;
}

}  // namespace cellmirror::scene
