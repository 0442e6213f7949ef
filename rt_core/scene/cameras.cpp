#include "rt_core/scene/cameras.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "rt_core/ports/camera_state.hpp"
#include "rt_core/scene/bounds.hpp"
#include "rt_core/scene/camera_mount.hpp"

namespace cellmirror::scene {

namespace {

const CameraSetting* setting_of(const CompiledCell& cell, const DisplayState& display, std::size_t camera) {
  const auto at = std::ranges::find_if(
      display.cameras, [&](const CameraSetting& setting) { return camera_named(cell, setting.name) == camera; });
  return at == display.cameras.end() ? nullptr : &*at;
}

// Solids of the camera's node and of what it is fixed to, along its axis without a gap. Meshes are skipped: a hall is
// one.
double housing_of(const CompiledCell& cell, std::int32_t node) {
  constexpr double kLargest = 0.3;  // m: more is no housing
  constexpr double kGap = 0.01;
  const std::int32_t parent = cell.parent[static_cast<std::size_t>(node)];
  const Pose X_CP = cell.X_PF[static_cast<std::size_t>(node)].inverse(Eigen::Isometry);
  std::vector<Box> solids;
  BoundsOfGeometry bounds;
  for (const CompiledGeometry& part : cell.geometry) {
    if ((part.node != node && part.node != parent) || part.geometry->shape == Shape::mesh || !part.geometry->drawn)
      continue;
    const Pose X_CG = part.node == node ? part.geometry->X_NG : X_CP * part.geometry->X_NG;
    const Box box = moved(X_CG, bounds.of(*part.geometry));
    if (box.isEmpty() || (box.min().head<2>().array() > 0).any() || (box.max().head<2>().array() < 0).any()) continue;
    if (box.sizes().maxCoeff() <= kLargest) solids.push_back(box);
  }
  std::ranges::sort(solids, {}, [](const Box& box) { return box.min().z(); });
  double reach = 0;
  for (const Box& box : solids) {
    if (box.min().z() <= (reach > 0 ? reach + kGap : 0.0)) reach = std::max(reach, box.max().z());
  }
  return reach;
}

CameraNow now_of(const CompiledCell& cell, const CellPoses& poses, const DisplayState& display, std::size_t index) {
  const CompiledCamera& camera = cell.cameras[index];
  CameraNow now;
  now.camera = index;
  now.X_WC = poses.X_WN[static_cast<std::size_t>(camera.node)];
  now.focal_distance_m = camera.focal_distance_m;
  now.fovy_rad = camera.fovy_rad;
  now.housing_m = housing_of(cell, camera.node);
  const CameraSetting* setting = setting_of(cell, display, index);
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
  const auto camera = camera_named(cell, name);
  if (!camera) return std::nullopt;
  return now_of(cell, poses, display, *camera);
}

std::uint32_t object_of_camera(const CompiledCell& cell, const CameraNow& camera) {
  return static_cast<std::uint32_t>(cell.cameras[camera.camera].node) + 1;
}

std::vector<CameraNow> cameras_now(const CompiledCell& cell, const CellPoses& poses, const DisplayState& display) {
  std::vector<CameraNow> cameras;
  cameras.reserve(cell.cameras.size());
  for (std::size_t i = 0; i < cell.cameras.size(); ++i) cameras.push_back(now_of(cell, poses, display, i));
  return cameras;
}

}  // namespace cellmirror::scene
