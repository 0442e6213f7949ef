// Building blocks of the table's rows, and the sections that the table is put together from. Private to the folder.
#pragma once

#include <limits>
#include <span>
#include <string_view>

#include "scripts/lang/command_table.hpp"
#include "scripts/lang/form.hpp"

namespace cellmirror::script {

std::span<const Form> general_forms();
std::span<const Form> device_forms();
std::span<const Form> robot_parameter_forms();
std::span<const Form> animation_forms();
std::span<const Form> dynamics_forms();
std::span<const Form> elastodynamic_forms();
std::span<const Form> channel_forms();
std::span<const Form> volume_forms();
std::span<const Form> own_forms();

namespace parts {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kMaxUnsigned = 4294967295.0;  // 32 bits

inline constexpr Range kAny{};
inline constexpr Range kPositive{0.0, kInfinity, true, false};
inline constexpr Range kNotNegative{0.0, kInfinity, false, false};
inline constexpr Range kUnsigned{0.0, kMaxUnsigned, false, false};
inline constexpr Range kOpeningAngle{0.0, 180.0, true, true};
inline constexpr Range kSharedMemoryKey{1.0, kMaxUnsigned, false, false};  // 0 is IPC_PRIVATE, which cannot be shared

inline constexpr Choice kOnOff[] = {{"on", "on"}, {"off", "off"}};
inline constexpr Choice kOnlineOffline[] = {{"online", "on"}, {"offline", "off"}};
inline constexpr Choice kZeroOne[] = {{"0", "off"}, {"1", "on"}};

constexpr Parameter word(std::string_view keyword) {
  return {.name = keyword, .meaning = "keyword", .kind = ParameterKind::word, .width = 0};
}

constexpr Parameter choice(std::string_view name, std::string_view meaning, std::span<const Choice> choices) {
  return {.name = name, .meaning = meaning, .kind = ParameterKind::choice, .choices = choices};
}

constexpr Parameter on_off(std::string_view meaning = "switch") { return choice("on | off", meaning, kOnOff); }

constexpr Parameter named(NameKind kind, std::string_view name, std::string_view meaning) {
  return {.name = name, .meaning = meaning, .kind = ParameterKind::name, .name_kind = kind};
}

constexpr Parameter frame(std::string_view name = "frame_node", std::string_view meaning = "frame or joint") {
  return named(NameKind::frame_node, name, meaning);
}

constexpr Parameter robot(std::string_view name = "Robot_id", std::string_view meaning = "robot") {
  return named(NameKind::robot, name, meaning);
}

constexpr Parameter camera(std::string_view name = "cam_id") { return named(NameKind::camera, name, "camera"); }

// Last argument of the commands for voxel volumes, ours.
constexpr Parameter one_volume() {
  Parameter parameter = named(NameKind::volume, "volume", "voxel volume");
  parameter.optional = true;
  parameter.default_text = "all volumes";
  return parameter;
}

constexpr Parameter file(std::string_view name, std::string_view meaning) {
  return {.name = name, .meaning = meaning, .kind = ParameterKind::file};
}

constexpr Parameter identifier(std::string_view name, std::string_view meaning) {
  return {.name = name, .meaning = meaning, .kind = ParameterKind::identifier};
}

constexpr Parameter integer(std::string_view name, std::string_view meaning, Range range, Unit unit = Unit::none) {
  return {.name = name, .meaning = meaning, .kind = ParameterKind::integer, .unit = unit, .range = range};
}

constexpr Parameter number(std::string_view name, std::string_view meaning, Unit unit, Range range = kAny) {
  return {.name = name, .meaning = meaning, .kind = ParameterKind::number, .unit = unit, .range = range};
}

// One value a joint, for each joint.
constexpr Parameter joints(std::string_view meaning, Unit unit, Range range = kAny) {
  return {.name = "n values",
          .meaning = meaning,
          .kind = ParameterKind::joint_list,
          .unit = unit,
          .range = range,
          .exact_count = true};
}

// One value a joint; fewer than joints leave the others.
constexpr Parameter some_joints(std::string_view meaning) {
  return {.name = "j1 ... jn", .meaning = meaning, .kind = ParameterKind::joint_list, .unit = Unit::joint_position};
}

constexpr Parameter optional(Parameter parameter, std::string_view default_text = {}) {
  parameter.optional = true;
  parameter.default_text = default_text;
  return parameter;
}

// `label` precedes the values; labelled groups come in any order.
constexpr Parameter labelled(std::string_view label, Parameter parameter, std::uint8_t width = 1,
                             std::uint8_t alternatives = 0) {
  parameter.label = label;
  parameter.width = width;
  parameter.alternatives = alternatives;
  return parameter;
}

constexpr Parameter optional_labelled(std::string_view label, Parameter parameter, std::uint8_t width = 1,
                                      std::uint8_t alternatives = 0) {
  return optional(labelled(label, parameter, width, alternatives));
}

}  // namespace parts
}  // namespace cellmirror::script
