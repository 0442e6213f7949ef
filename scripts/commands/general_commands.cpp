// Manual 1.2.1.
#include <array>
#include <optional>

#include "rt_core/base/pose.hpp"
#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

Outcome activate(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.world.activate(command.text(kOnlySlot)));
}
Outcome deactivate(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.world.deactivate(command.text(kOnlySlot)));
}
Outcome delete_node(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.world.delete_node(command.text(kOnlySlot)));
}
Outcome swap_node(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.world.swap_node(command.text(kOnlySlot)));
}
Outcome level_down(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.world.level_down(command.text(kOnlySlot)));
}
Outcome level_up(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.world.level_up(command.text(kOnlySlot)));
}

Outcome robot_language(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.programs.set_language(command.text(kOnlySlot)));
}

Outcome robact(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.robots.set_active_robot(command.text(kOnlySlot)));
}

Outcome exec_script(const ParsedCommand& command, CommandHost& /*host*/) {
  Outcome outcome;
  outcome.kind = Outcome::Kind::call_script;
  outcome.script = command.text(kOnlySlot);
  return outcome;
}

Outcome draw_scene(const ParsedCommand& /*command*/, CommandHost& host) { return Outcome::of(host.world.draw_scene()); }

Outcome connect(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(
      host.world.connect(command.text(slots::connect::kAttached), command.text(slots::connect::kPredecessor)));
}

Outcome frame_to_workframe(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.world.attach_at_workframe(command.text(slots::connect::kAttached),
                                                    command.text(slots::connect::kPredecessor),
                                                    command.text(slots::connect::kWorkframe)));
}

Outcome set_placement(const ParsedCommand& command, CommandHost& host) {
  const Eigen::Vector3d rpy = vector_at(command, slots::placement::kRotation);
  const Eigen::Vector3d xyz = vector_at(command, slots::placement::kTranslation);
  return Outcome::of(host.world.set_placement(command.text(slots::placement::kFrame), pose_from_xyz_rpy(xyz, rpy)));
}

// The first choice of both switches is "on".
Outcome set_online(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.robots.set_online(command.text(slots::robot_online::kRobot),
                                            command.choice(slots::robot_online::kOnline) == 0));
}
Outcome set_sending(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.robots.set_sending(command.text(slots::robot_sending::kRobot),
                                             command.choice(slots::robot_sending::kSending) == 0));
}

Outcome set_camera(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.set_camera(command.text(slots::campar::kCamera),
                                             command.number(slots::campar::kFocalDistance),
                                             command.number(slots::campar::kOpeningAngle)));
}

// In the order of the table.
DrawMode draw_mode(const ParsedCommand& command) {
  constexpr std::array<DrawMode, 4> kModes = {DrawMode::wireframe, DrawMode::flat, DrawMode::gouraud,
                                              DrawMode::transparent};
  return kModes[command.choice(slots::render::kMode)];
}

Outcome set_frame_render(const ParsedCommand& command, CommandHost& host) {
  return Outcome::with_remark(
      host.display.set_draw_mode(command.text(slots::render::kFrame), false, draw_mode(command)));
}
Outcome set_abstract_render(const ParsedCommand& command, CommandHost& host) {
  return Outcome::with_remark(
      host.display.set_draw_mode(command.text(slots::render::kFrame), true, draw_mode(command)));
}

Outcome load_views(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.load_views(command.text(kOnlySlot)));
}

Outcome tag_drawlen(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.set_tag_length(command.number(kOnlySlot)));
}

// The first choice of all three switches is "on"; the parser ensures that a target comes with "on" only.
Outcome cam_tracking(const ParsedCommand& command, CommandHost& host) {
  const std::optional<std::string_view> target = command.choice(slots::camera_switch::kOn) == 0
                                                     ? std::optional(command.text(slots::camera_switch::kTarget))
                                                     : std::nullopt;
  return Outcome::of(host.display.track(command.text(slots::camera_switch::kCamera), target));
}
Outcome cam_view_pyramid(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.show_pyramid(command.text(slots::camera_switch::kCamera),
                                               command.choice(slots::camera_switch::kOn) == 0));
}
Outcome cam_online(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.set_camera_online(command.text(slots::camera_switch::kCamera),
                                                    command.choice(slots::camera_switch::kOn) == 0));
}

constexpr Registration kHandlers[] = {
    {FormId::activate, activate},
    {FormId::deactivate, deactivate},
    {FormId::delete_node, delete_node},
    {FormId::swap_node, swap_node},
    {FormId::level_down, level_down},
    {FormId::level_up, level_up},
    {FormId::robot_language, robot_language},
    {FormId::robact, robact},
    {FormId::load_views, load_views},
    {FormId::exec_script, exec_script},
    {FormId::draw_scene, draw_scene},
    {FormId::connect, connect},
    {FormId::frame_to_wfrm, frame_to_workframe},
    {FormId::set_frame_render, set_frame_render},
    {FormId::set_frame_placement, set_placement},
    {FormId::set_abstract_render, set_abstract_render},
    {FormId::robot_online, set_online},
    {FormId::robot_sending, set_sending},
    {FormId::set_campar, set_camera},
    {FormId::tag_drawlen, tag_drawlen},
    {FormId::cam_tracking, cam_tracking},
    {FormId::cam_view_pyramid, cam_view_pyramid},
    {FormId::cam_online, cam_online},
};

}  // namespace

std::span<const Registration> general_handlers() { return kHandlers; }

}  // namespace cellmirror::script
