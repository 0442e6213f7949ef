#include "rt_core/scene/camera_mount.hpp"

#include <algorithm>
#include <cmath>

#include "rt_core/base/contract.hpp"
#include "rt_core/scene/paths.hpp"

namespace cellmirror::scene {
namespace {

constexpr std::size_t kMostHeadJoints = 2;
constexpr double kNowhere = 1e-9;  // m; nearer than that there is no direction

std::size_t index(std::int32_t node) { return static_cast<std::size_t>(node); }

// Joint nodes from the camera up, of its carrier only.
std::vector<std::int32_t> carrying_joints(const CompiledCell& cell, std::size_t camera, std::size_t slot) {
  std::vector<std::int32_t> nodes;
  for (std::int32_t node = cell.cameras[camera].node; node > 0; node = cell.parent[index(node)]) {
    const std::int32_t joint = cell.joint_of[index(node)];
    if (joint >= 0 && cell.joints[index(joint)].slot == slot) nodes.push_back(node);
  }
  return nodes;
}

bool is_head(const CompiledCell& cell, const std::vector<std::int32_t>& joint_nodes) {
  return joint_nodes.size() <= kMostHeadJoints && std::ranges::all_of(joint_nodes, [&](std::int32_t node) {
           return cell.joints[index(cell.joint_of[index(node)])].kind != JointKind::prismatic;
         });
}

std::optional<std::size_t> node_of(const CompiledCell& cell, const std::string& path) {
  if (path.empty() || !cell.paths) return {};
  const auto found = std::ranges::find(*cell.paths, path);
  if (found == cell.paths->end()) return {};
  return static_cast<std::size_t>(found - cell.paths->begin());
}

}  // namespace

std::optional<std::size_t> camera_named(const CompiledCell& cell, std::string_view name) {
  std::optional<std::size_t> ending;
  for (std::size_t camera = 0; camera < cell.cameras.size(); ++camera) {
    const std::int32_t node = cell.cameras[camera].node;
    if (path_of(cell, node) == name) return camera;
    if (!ending && names_node(cell, name, node)) ending = camera;
  }
  return ending;
}

std::optional<std::size_t> carrier_slot(const CompiledCell& cell, std::size_t camera) {
  CELLMIRROR_EXPECTS(camera < cell.cameras.size());
  for (std::int32_t node = cell.cameras[camera].node; node > 0; node = cell.parent[index(node)]) {
    const std::int32_t joint = cell.joint_of[index(node)];
    if (joint >= 0) return cell.joints[index(joint)].slot;
  }
  return {};
}

Pose mount_pose(const CompiledCell& cell, const CellPoses& poses, std::size_t camera) {
  const std::int32_t camera_node = cell.cameras[camera].node;
  const std::optional<std::size_t> slot = carrier_slot(cell, camera);
  const auto joint_nodes = slot ? carrying_joints(cell, camera, *slot) : std::vector<std::int32_t>{};
  if (joint_nodes.empty() || !is_head(cell, joint_nodes)) return poses.X_WN[index(camera_node)];
  // X_PF is the pose at joint position zero.
  const std::int32_t above = cell.parent[index(joint_nodes.back())];
  Pose X_AC = Pose::Identity();
  for (std::int32_t node = camera_node; node != above; node = cell.parent[index(node)]) {
    X_AC = cell.X_PF[index(node)] * X_AC;
  }
  return above < 0 ? X_AC : poses.X_WN[index(above)] * X_AC;
}

PanTilt pan_tilt_towards(const Eigen::Vector3d& direction_M) {
  const double level = std::hypot(direction_M.x(), direction_M.z());
  if (!(direction_M.norm() > kNowhere)) return {};
  PanTilt angles;
  if (level > kNowhere) angles.pan_rad = std::atan2(direction_M.x(), direction_M.z());
  angles.tilt_rad = std::atan2(-direction_M.y(), level);
  return angles;
}

Eigen::Matrix3d rotation_of(const PanTilt& angles) {
  return (Eigen::AngleAxisd(angles.pan_rad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(angles.tilt_rad, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

CameraState camera_state(const CompiledCell& cell, const CellPoses& poses, const CameraSetting& setting,
                         std::size_t camera) {
  CELLMIRROR_EXPECTS(camera < cell.cameras.size());
  const CompiledCamera& compiled = cell.cameras[camera];
  CameraState state;
  state.name = setting.name.empty() ? compiled.name : setting.name;  // its path where others have the same name
  state.X_WC = poses.X_WN[index(compiled.node)];
  state.X_WM = mount_pose(cell, poses, camera);
  state.focal_distance_m = compiled.focal_distance_m;
  state.fovy_rad = compiled.fovy_rad;
  state.mirrored = setting.mirrored;
  Eigen::Vector3d direction_M = state.X_WM.linear().transpose() * state.X_WC.linear().col(2);
  if (const auto target = node_of(cell, setting.tracks)) {
    const Eigen::Vector3d p_CT = poses.X_WN[*target].translation() - state.X_WC.translation();
    if (p_CT.norm() > kNowhere) {
      state.tracking = true;
      state.tracks = setting.tracks;
      state.focal_distance_m = p_CT.norm();
      direction_M = state.X_WM.linear().transpose() * p_CT;
    }
  }
  const PanTilt angles = pan_tilt_towards(direction_M);
  state.pan_rad = angles.pan_rad;
  state.tilt_rad = angles.tilt_rad;
  if (state.tracking) state.X_WC.linear() = state.X_WM.linear() * rotation_of(angles);
  return state;
}

std::vector<CameraState> online_cameras(const CompiledCell& cell, const CellPoses& poses, const DisplayState& display) {
  std::vector<CameraState> states;
  for (std::size_t camera = 0; camera < cell.cameras.size(); ++camera) {
    const auto setting = std::ranges::find_if(
        display.cameras, [&](const CameraSetting& known) { return camera_named(cell, known.name) == camera; });
    if (setting == display.cameras.end() || !setting->online) continue;
    states.push_back(camera_state(cell, poses, *setting, camera));
  }
  return states;
}

}  // namespace cellmirror::scene
