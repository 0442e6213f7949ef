// Of DisplayService, what concerns cameras, and what follows the cell.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/owner/display/display_service.hpp"
#include "rt_core/scene/camera_mount.hpp"

namespace cellmirror::app {

namespace {

bool is_unique(const CompiledCell& cell, std::string_view name) {
  return std::ranges::count(cell.cameras, name, &CompiledCamera::name) == 1;
}

std::optional<std::size_t> place_in(const std::vector<std::string>& paths, std::string_view path) {
  const auto at = std::ranges::find(paths, path);
  return at == paths.end() ? std::nullopt : std::optional(static_cast<std::size_t>(at - paths.begin()));
}

constexpr double kNowhere = 1e-9;  // m; nearer than that there is no direction (scene::camera_state)

double distance(const Cell& cell, NodeId a, NodeId b, std::span<const JointValues> q) {
  return (cell.world_pose(a, q).translation() - cell.world_pose(b, q).translation()).norm();
}

// Hang on one frame that is not the world, so that what carries the one carries the other.
bool have_one_carrier(const Cell& cell, NodeId a, NodeId b) {
  for (NodeId carrier = a; carrier != kRootNode; carrier = cell.node(carrier).predecessor) {
    for (NodeId node = b; node != kRootNode; node = cell.node(node).predecessor) {
      if (node == carrier) return true;
    }
  }
  return false;
}

// Whatever the joints do: at postures that bring nothing together by chance.
bool always_in_one_place(const Cell& cell, NodeId a, NodeId b, std::span<const JointValues> q) {
  constexpr int kPostures = 3;
  std::vector<JointValues> posture(q.begin(), q.end());
  for (int i = 0; i < kPostures; ++i) {
    if (distance(cell, a, b, posture) > kNowhere) return false;
    for (JointValues& joints : posture) {
      double step = 0.37;  // rad or m
      for (double& joint : joints) {
        joint += step;
        step += 0.11;
      }
    }
  }
  return true;
}

}  // namespace

Result<std::string> DisplayService::camera_name(std::string_view camera) const {
  const auto node = parts_.cell.find(camera, PathKind::camera);
  if (!node) return std::unexpected(node.error());
  const std::string path = parts_.cell.path(*node);
  const std::string bare = path.substr(path.rfind('.') + 1);
  return is_unique(*parts_.cell.compile(), bare) ? bare : path;
}

Result<CameraSetting*> DisplayService::select_camera(std::string_view camera) {
  follow_cell();
  auto name = camera_name(camera);
  if (!name) return std::unexpected(name.error());
  const auto setting = std::ranges::find(state_.cameras, *name, &CameraSetting::name);
  if (setting == state_.cameras.end()) return fail(fmt::format("there is no camera {}", *name));
  state_.current_camera = *std::move(name);
  changed();
  return &*setting;
}

// A frame that is gone is tracked no more, a view of a camera that is gone stays where it was set, and a robot that is
// gone has no arc. Draw rules stay: they count again when their component is loaded again. A camera is known again by
// its path: its name in the state is another one once a second camera of that name comes or goes.
void DisplayService::follow_cell() {
  if (parts_.cell.revision() == cell_revision_) return;
  cell_revision_ = parts_.cell.revision();
  const auto cell = parts_.cell.compile();
  std::vector<CameraSetting> cameras;
  std::vector<std::string> paths;
  for (const CompiledCamera& camera : cell->cameras) {
    const std::string& path = (*cell->paths)[static_cast<std::size_t>(camera.node)];
    const auto old = place_in(camera_paths_, path);
    CameraSetting setting = old ? state_.cameras[*old] : CameraSetting{};
    setting.name = is_unique(*cell, camera.name) ? camera.name : path;
    if (!setting.tracks.empty() && !parts_.cell.knows(setting.tracks)) setting.tracks.clear();
    cameras.push_back(std::move(setting));
    paths.push_back(path);
  }
  const auto name_now = [&](std::string_view before) -> std::string {
    const auto old = std::ranges::find(state_.cameras, before, &CameraSetting::name);
    if (old == state_.cameras.end()) return {};
    const auto now = place_in(paths, camera_paths_[static_cast<std::size_t>(old - state_.cameras.begin())]);
    return now ? cameras[*now].name : std::string();
  };
  for (DisplayView& shown : state_.views) shown.camera = name_now(shown.camera);
  state_.current_camera = name_now(state_.current_camera);
  if (cameras.empty()) state_.modes.reset(static_cast<std::size_t>(DisplayMode::camera_main_view));
  std::erase_if(state_.arcs, [&](const std::string& robot) { return parts_.cell.robot(robot) == nullptr; });
  state_.cameras = std::move(cameras);
  camera_paths_ = std::move(paths);
  changed();
}

void DisplayService::follow_carriers() {
  if (!parts_.is_online) return;
  const auto cell = parts_.cell.compile();
  for (std::size_t i = 0; i < state_.cameras.size(); ++i) {
    const auto slot = scene::carrier_slot(*cell, i);
    const bool mirrored = slot && parts_.is_online(*slot);
    if (state_.cameras[i].mirrored == mirrored) continue;
    state_.cameras[i].mirrored = mirrored;
    changed();
  }
}

bool DisplayService::is_elsewhere(NodeId camera, NodeId target) const {
  return distance(parts_.cell, camera, target, parts_.positions()) > kNowhere;
}

void DisplayService::follow_targets() {
  for (std::size_t i = 0; i < state_.cameras.size(); ++i) {
    CameraSetting& setting = state_.cameras[i];
    bool tracking = false;
    if (!setting.tracks.empty()) {
      const auto target = parts_.cell.find(setting.tracks);
      const auto camera = parts_.cell.find(camera_paths_[i], PathKind::camera);
      tracking = target && camera && is_elsewhere(*camera, *target);
    }
    if (setting.tracking == tracking) continue;
    setting.tracking = tracking;
    changed();
  }
}

Result<void> DisplayService::connect_view(int id, std::string_view camera) {
  if (auto known = check_view_id(id); !known) return known;
  if (auto opened = select_camera(camera); !opened) return std::unexpected(opened.error());
  view(id).camera = state_.current_camera;
  view(id).front_plane_set = false;
  view(id).sequence.reset();
  return {};
}

// At once, whatever the pace: a view at a camera is on no way.
Result<void> DisplayService::set_planes_at_camera(int id, const ViewChange& change) {
  const DisplayView before = view(id);
  view(id).view = changed_by(before.view, change);
  view(id).front_plane_set = before.front_plane_set || change.near_distance.has_value();
  auto checked = check_view(id, view(id).view);
  if (checked) checked = check_view(id, view_now(id));
  if (!checked) view(id) = before;
  if (checked) changed();
  return checked;
}

Result<void> DisplayService::set_camera(std::string_view camera, double focal_distance_m, double fovy_rad) {
  if (auto set = parts_.cell.set_camera(camera, focal_distance_m, fovy_rad); !set) return set;
  if (auto opened = select_camera(camera); !opened) return std::unexpected(opened.error());
  return {};
}

Result<void> DisplayService::track(std::string_view camera, std::optional<std::string_view> frame) {
  std::string target;
  if (frame) {
    const auto node = parts_.cell.find(*frame);
    if (!node) return std::unexpected(node.error());
    target = parts_.cell.path(*node);
    const auto itself = parts_.cell.find(camera, PathKind::camera);
    if (itself && *itself == *node) {
      return fail(fmt::format("the camera {} cannot look at itself", camera), "give another frame to look at");
    }
    if (itself && have_one_carrier(parts_.cell, *itself, *node) &&
        always_in_one_place(parts_.cell, *itself, *node, parts_.positions())) {
      return fail(fmt::format("{} lies where the camera {} is, and goes along with it", target, camera),
                  "give another frame to look at");
    }
  }
  const auto setting = select_camera(camera);
  if (!setting) return std::unexpected(setting.error());
  (*setting)->tracks = std::move(target);
  follow_targets();
  return {};
}

Result<void> DisplayService::show_pyramid(std::string_view camera, bool on) {
  const auto setting = select_camera(camera);
  if (!setting) return std::unexpected(setting.error());
  (*setting)->pyramid = on;
  return {};
}

Result<void> DisplayService::set_camera_online(std::string_view camera, bool on) {
  const auto setting = select_camera(camera);
  if (!setting) return std::unexpected(setting.error());
  (*setting)->online = on;
  return {};
}

}  // namespace cellmirror::app
