#include "app/owner/hosts.hpp"

#include <fmt/format.h>

#include <utility>

#include "app/owner/volume/volume_names.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::app {

namespace {

PathKind path_kind(NameKind kind) {
  switch (kind) {
    case NameKind::workframe:
      return PathKind::workframe;
    case NameKind::camera:
      return PathKind::camera;
    case NameKind::sensor:
      return PathKind::sensor;
    case NameKind::frame_node:
    case NameKind::branch:
    case NameKind::volume:
    case NameKind::robot:
      return PathKind::any;
  }
  return PathKind::any;
}

}  // namespace

bool CellNames::knows(NameKind kind, std::string_view name) const {
  if (kind == NameKind::robot) return cell_.robot(name) != nullptr;
  if (kind == NameKind::volume) return find_volume(cell_, name).has_value();
  return kind == NameKind::branch ? cell_.find_branch(name).has_value() : cell_.knows(name, path_kind(kind));
}

Error CellNames::explain(NameKind kind, std::string_view name) const {
  if (kind == NameKind::robot) return cell_.explain_robot(name);
  if (kind == NameKind::volume) {
    auto found = find_volume(cell_, name);
    return found ? Error() : std::move(found.error());
  }
  return cell_.explain(name, path_kind(kind));
}

std::span<const JointKind> CellNames::joints(std::string_view robot) const {
  const RobotModel* model = cell_.robot(robot);
  return model == nullptr ? std::span<const JointKind>() : model->joint_kinds();
}

std::vector<std::string> CellNames::joint_names(std::string_view robot) const {
  const RobotModel* model = cell_.robot(robot);
  return model == nullptr ? std::vector<std::string>() : model->joint_names();
}

std::string_view CellNames::active_robot() const {
  // A robot that was deleted with its component is active no longer.
  return cell_.robot(active_) == nullptr ? std::string_view() : std::string_view(active_);
}

std::vector<std::string> CellNames::all(NameKind kind) const {
  if (kind == NameKind::robot) return cell_.robot_ids();
  return kind == NameKind::volume ? volume_names(cell_) : cell_.paths(path_kind(kind));
}

Result<void> CellWorld::followed(Result<void> changed) {
  if (!changed) return changed;
  parts_.volumes.follow_cell();
  parts_.programs.follow_cell();
  parts_.motion.follow_cell();
  return parts_.fleet.follow_cell();
}

Result<void> CellWorld::activate(std::string_view node) { return followed(parts_.cell.activate(node)); }
Result<void> CellWorld::deactivate(std::string_view node) { return parts_.cell.deactivate(node); }
Result<void> CellWorld::delete_node(std::string_view node) { return followed(parts_.cell.delete_node(node)); }
Result<void> CellWorld::swap_node(std::string_view node) { return followed(parts_.cell.swap_node(node)); }
Result<void> CellWorld::level_down(std::string_view node) { return followed(parts_.cell.level_down(node)); }
Result<void> CellWorld::level_up(std::string_view node) { return parts_.cell.level_up(node); }

Result<void> CellWorld::set_placement(std::string_view node, const Pose& X_PF) {
  return parts_.cell.set_placement(node, X_PF);
}

Result<void> CellWorld::connect(std::string_view part, std::string_view predecessor) {
  return parts_.cell.connect(part, predecessor, parts_.fleet.positions());
}

Result<void> CellWorld::attach_at_workframe(std::string_view part, std::string_view predecessor,
                                            std::string_view workframe) {
  return parts_.cell.attach_at_workframe(part, predecessor, workframe);
}

Result<void> CellWorld::draw_scene() {
  auto settled = parts_.fleet.settle();
  if (settled) parts_.draw();
  return settled;
}

Result<void> CellRobots::set_active_robot(std::string_view robot) {
  if (cell_.robot(robot) == nullptr) return std::unexpected(cell_.explain_robot(robot));
  names_.set_active(robot);
  return {};
}

// Whatever a robot does ends where it goes online, and what it was commanded to before counts no more when it comes
// back.
Result<void> CellRobots::set_online(std::string_view robot, bool online) {
  const FleetRobot* known = fleet_.find(robot);
  const bool changes = known != nullptr && known->online != online;
  if (online && changes && !couplings_.master_of(robot).empty()) {
    return fail(fmt::format("{} follows {}, so it cannot follow its stream", robot, couplings_.master_of(robot)),
                "free it first with MASTER_SLAVE off");
  }
  auto set = fleet_.set_online(robot, online);
  if (!set || !changes) return set;
  const Error why{fmt::format("the robot {} went {}", robot, online ? "online" : "offline"), {}};
  programs_.cancel(robot, why);
  motion_.cancel(robot, why);
  return set;
}

Result<RobotModel*> CellRobots::active() {
  RobotModel* robot = names_.active_robot().empty() ? nullptr : cell_.edit_robot(names_.active_robot());
  if (robot == nullptr) return fail("no robot is active", "activate one with ROBACT <robot>");
  return robot;
}

Result<std::string> CellRobots::set_joint_parameter(JointParameter which, std::span<const double> values) {
  auto robot = active();
  if (!robot) return std::unexpected(robot.error());
  if (auto set = (*robot)->set_joint_parameter(which, values); !set) return std::unexpected(set.error());
  if (which == JointParameter::start_position) return begin_at_start(**robot);
  Result<void> followed;
  if (which == JointParameter::max_velocity || which == JointParameter::max_acceleration)
    followed = couplings_.update_limits(**robot);
  if (which == JointParameter::max_range || which == JointParameter::min_range)
    followed = fleet_.update_limits(**robot);
  if (!followed) return std::unexpected(followed.error());
  return std::string();
}

Result<std::string> CellRobots::begin_at_start(const RobotModel& robot) {
  const auto began = fleet_.begin_at(robot.id(), robot.parameters().start_position);
  if (!began) return std::unexpected(began.error());
  if (*began) return std::string();
  return fmt::format("{} is no longer at its start position; MOVE_ROB {} PTP START moves it there", robot.id(),
                     robot.id());
}

Result<void> CellRobots::set_scalar_parameter(ScalarParameter which, double value) {
  auto robot = active();
  return robot ? (*robot)->set_scalar_parameter(which, value) : std::unexpected(robot.error());
}

Result<void> CellRobots::set_fly(FlyType type, double parameter) {
  auto robot = active();
  return robot ? (*robot)->set_fly(type, parameter) : std::unexpected(robot.error());
}

Result<void> CellRobots::set_ptp_mode(PtpMode mode) {
  auto robot = active();
  if (!robot) return std::unexpected(robot.error());
  (*robot)->set_ptp_mode(mode);
  return {};
}

Result<void> CellRobots::set_velocity_profile(VelocityProfile profile) {
  auto robot = active();
  if (!robot) return std::unexpected(robot.error());
  (*robot)->set_velocity_profile(profile);
  return {};
}

Result<void> CellRobots::set_inverse_class(InverseClass inverse_class) {
  auto robot = active();
  if (!robot) return std::unexpected(robot.error());
  (*robot)->set_inverse_class(inverse_class);
  return {};
}

Result<void> CellRobots::set_point_of_reference(const Pose& X_FP) {
  auto robot = active();
  return robot ? (*robot)->set_point_of_reference(X_FP) : std::unexpected(robot.error());
}

Result<void> CellRobots::set_tool_center_point(const Pose& X_PT) {
  auto robot = active();
  return robot ? (*robot)->set_tool_center_point(X_PT) : std::unexpected(robot.error());
}

}  // namespace cellmirror::app
