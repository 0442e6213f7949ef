// Manual 1.2.1.
#include <array>
#include <optional>

#include "rt_core/base/pose.hpp"
#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

Outcome activate(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.world.activate(command.text(0)));
}
Outcome deactivate(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.world.deactivate(command.text(0)));
}
Outcome delete_node(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.world.delete_node(command.text(0)));
}
Outcome swap_node(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.world.swap_node(command.text(0)));
}
Outcome level_down(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.world.level_down(command.text(0)));
}
Outcome level_up(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.world.level_up(command.text(0)));
}

Outcome robot_language(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.programs.set_language(command.text(0)));
}

Outcome robact(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.robots.set_active_robot(command.text(0)));
}

Outcome exec_script(const ParsedCommand& command, CommandHost& /*host*/) {
  Outcome outcome;
  outcome.kind = Outcome::Kind::call_script;
  outcome.script = command.text(0);
  return outcome;
}

Outcome draw_scene(const ParsedCommand& /*command*/, CommandHost& host) { return Outcome::of(host.world.draw_scene()); }

Outcome connect(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.world.connect(command.text(0), command.text(1)));
}

Outcome frame_to_workframe(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.world.attach_at_workframe(command.text(0), command.text(1), command.text(2)));
}

Outcome set_placement(const ParsedCommand& command, CommandHost& host) {
  const Eigen::Vector3d rpy(command.number(1), command.number(2), command.number(3));
  const Eigen::Vector3d xyz(command.number(4), command.number(5), command.number(6));
  return Outcome::of(host.world.set_placement(command.text(0), pose_from_xyz_rpy(xyz, rpy)));
}

// The first choice of both switches is "on".
Outcome set_online(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.robots.set_online(command.text(0), command.choice(1) == 0));
}
Outcome set_sending(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.robots.set_sending(command.text(0), command.choice(1) == 0));
}

Outcome set_camera(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.set_camera(command.text(0), command.number(1), command.number(2)));
}

// In the order of the table.
DrawMode draw_mode(const ParsedCommand& command, std::size_t slot) {
  constexpr std::array<DrawMode, 4> kModes = {DrawMode::wireframe, DrawMode::flat, DrawMode::gouraud,
                                              DrawMode::transparent};
  return kModes[command.choice(slot)];
}

Outcome set_frame_render(const ParsedCommand& command, CommandHost& host) {
  return Outcome::with_remark(host.display.set_draw_mode(command.text(0), false, draw_mode(command, 1)));
}
Outcome set_abstract_render(const ParsedCommand& command, CommandHost& host) {
  return Outcome::with_remark(host.display.set_draw_mode(command.text(0), true, draw_mode(command, 1)));
}

Outcome load_views(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.load_views(command.text(0)));
}

Outcome tag_drawlen(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.set_tag_length(command.number(0)));
}

// The first choice of all three switches is "on"; the parser ensures that a target comes with "on" only.
Outcome cam_tracking(const ParsedCommand& command, CommandHost& host) {
  const std::optional<std::string_view> target = command.choice(1) == 0 ? std::optional(command.text(2)) : std::nullopt;
  return Outcome::of(host.display.track(command.text(0), target));
}
Outcome cam_view_pyramid(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.show_pyramid(command.text(0), command.choice(1) == 0));
}
Outcome cam_online(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.set_camera_online(command.text(0), command.choice(1) == 0));
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
