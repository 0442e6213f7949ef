#include "app/new_cell/robot_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>

#include "app/new_cell/mesh_sources.hpp"
#include "app/new_cell/names.hpp"
#include "config/parse.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/base/pose.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/cell/component.hpp"

namespace cellmirror::app {

namespace fs = std::filesystem;

namespace {

std::vector<PlannedJoint> joints_of(const Component& component) {
  std::vector<PlannedJoint> joints;
  for (const int index : component.robot->joints) {
    const ComponentNode& node = component.nodes[static_cast<std::size_t>(index)];
    const JointDefinition& joint = *node.joint;
    joints.push_back(
        {node.name, joint.kind, joint.min_position, joint.max_position, joint.start_position, joint.max_velocity});
  }
  return joints;
}

// The pose of the link in the root of the URDF, as far as no joint moves between them.
std::optional<Pose> fixed_pose_of(const Component& component, const ComponentNode& link) {
  Pose X_RL = link.X_PF;
  for (int at = link.parent; at >= 0;) {
    const ComponentNode& node = component.nodes[static_cast<std::size_t>(at)];
    if (node.joint) return std::nullopt;
    X_RL = node.X_PF * X_RL;
    at = node.parent;
  }
  return X_RL;
}

// Places the root so that the link `base` stands at the wanted point, upright as the world.
void place_base(const Component& component, const NewCellRequest& request, PlannedRobot& robot,
                Diagnostics& diagnostics) {
  const Eigen::Vector3d xyz(request.xyz_m[0], request.xyz_m[1], request.xyz_m[2]);
  robot.xyz_m = xyz;
  if (request.base.empty()) return;
  const Place place{request.urdf.string(), 0, 0};
  std::vector<std::string> links;
  for (const ComponentNode& node : component.nodes) {
    if (!node.joint) links.push_back(node.name);
  }
  const auto link = std::ranges::find_if(
      component.nodes, [&](const ComponentNode& node) { return !node.joint && node.name == request.base; });
  if (link == component.nodes.end()) {
    diagnostics.error(place, fmt::format("there is no link {}", printable(request.base)),
                      did_you_mean(request.base, links));
    return;
  }
  const auto X_RB = fixed_pose_of(component, *link);
  if (!X_RB) {
    diagnostics.error(place, fmt::format("a joint moves between the root link and {}", printable(request.base)),
                      "take a link that does not move as the base");
    return;
  }
  const Pose X_WR = pose_from_xyz_rpy(xyz, Eigen::Vector3d::Zero()) * X_RB->inverse();
  robot.xyz_m = X_WR.translation();
  robot.rpy_rad = rpy_from_rotation(X_WR.linear());
  if (link != component.nodes.begin()) robot.base = request.base;
}

}  // namespace

std::optional<RobotSource> read_robot_source(const NewCellRequest& request, Diagnostics& diagnostics) {
  const Place whole{request.urdf.string(), 0, 0};
  std::error_code error;
  const fs::path urdf = fs::canonical(request.urdf, error);
  const auto text =
      error ? Result<std::string>(fail("there is no such file", "check the path")) : read_text_file(urdf, kLargestText);
  if (!text) {
    diagnostics.error(whole, text.error().what, text.error().remedy);
    return std::nullopt;
  }
  std::string stem = plain_file_name(fs::path(request.urdf).stem().string());
  const std::string folder = "robots/" + stem;
  const fs::path named_folder = fs::canonical(fs::absolute(request.urdf, error).parent_path(), error);
  MeshSources meshes(urdf, folder, named_folder);
  const std::size_t errors_before = diagnostics.errors();
  const auto component = parse_urdf(*text, request.urdf.string(), urdf, meshes, diagnostics);
  if (!component || diagnostics.errors() != errors_before) return std::nullopt;
  if (!component->robot) {
    diagnostics.error(whole, "no joint of it moves", "a cell mirrors robots; give the URDF of one");
    return std::nullopt;
  }
  RobotSource source;
  source.robot.node = "Arm";
  source.robot.id = component->robot->id;
  source.robot.file = stem + "/" + stem + ".urdf";
  source.robot.joints = joints_of(*component);
  place_base(*component, request, source.robot, diagnostics);
  auto files = meshes.files();
  if (!files) diagnostics.error(whole, files.error().what, files.error().remedy);
  if (diagnostics.errors() != errors_before) return std::nullopt;
  source.files = std::move(*files);
  source.files.push_back({{}, "robots/" + source.robot.file, meshes.rewritten(*text)});
  return source;
}

}  // namespace cellmirror::app
