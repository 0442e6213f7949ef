// MoveAbsJ, MoveJ and MoveL.
#include <fmt/format.h>

#include <algorithm>

#include "rt_core/base/text.hpp"
#include "rt_core/base/units.hpp"
#include "scripts/programs/rapid/parser.hpp"

namespace cellmirror::program::rapid {
namespace {

// The greatest predefined speed stands for all of what the joints can do: how fast a TCP moves while joints move at a
// given share depends on the robot and its pose.
constexpr double kFullSpeed = 7000;  // mm/s

}  // namespace

bool Parser::move_joints_absolute(const Token& at) { return move(at, PathKind::joints, Type::jointtarget); }
bool Parser::move_joints(const Token& at) { return move(at, PathKind::joints, Type::robtarget); }
bool Parser::move_linear(const Token& at) { return move(at, PathKind::linear, Type::robtarget); }

// Move [\switch, ] target, speed, zone, tool0 [\WObj:=wobj0]
bool Parser::move(const Token& at, PathKind path, Type target_type) {
  if (!refuse_switches(false)) return false;
  if (lexer_.at(Sign::comma)) lexer_.advance();
  const std::optional<Operand> target = values_.read(target_type, fmt::format("the target of {}", at.text));
  if (!target || !refuse_switches(false) || !values_.expect(Sign::comma, ",")) return false;
  bool speed_known = false;
  const std::optional<Speed> speed = values_.read_speed(speed_known);
  if (!speed || !refuse_switches(false) || !values_.expect(Sign::comma, ",")) return false;
  bool zone_known = false;
  const std::optional<Zone> zone = read_zone(zone_known);
  if (!zone || !refuse_switches(false) || !values_.expect(Sign::comma, ",")) return false;
  if (!read_frame("tool", "tool0") || !refuse_switches(true)) return false;
  if (!target->known() || !speed_known || !zone_known) return true;
  set_speed(path, *speed, at);
  if (!zone->fine) set(Setting::fly_distance, zone->radius_mm * kMPerMm, at);
  MoveStatement statement;
  statement.path = path;
  statement.kind = target_type == Type::robtarget ? TargetKind::pose_absolute : TargetKind::joints_absolute;
  statement.fly = !zone->fine;
  statement.target = target->id;
  uses_tool_ = uses_tool_ || target_type == Type::robtarget;
  add(at, statement);
  return true;
}

void Parser::set_speed(PathKind path, const Speed& speed, const Token& at) {
  std::optional<double> share;
  std::optional<double> path_speed;
  std::optional<double> turn_speed;
  if (!speed.own()) {
    share = std::min(1.0, speed.path_mm_s / kFullSpeed);
    path_speed = speed.path_mm_s * kMPerMm;
    turn_speed = speed.turn_deg_s * kRadPerDeg;
  }
  if (path == PathKind::joints) {
    set(Setting::joint_velocity, share, at);
  } else {
    set(Setting::linear_velocity, path_speed, at);
    set(Setting::rotational_velocity, turn_speed, at);
  }
}

void Parser::set(Setting setting, std::optional<double> value, const Token& at) {
  add(at, SetStatement{setting, value ? builder_.real(*value) : kNoExpression});
}

std::optional<Zone> Parser::read_zone(bool& known) {
  const Token at = lexer_.token();
  if (at.kind != TokenKind::word) {
    values_.error(at, fmt::format("a zone is missing before {}", shown(at)),
                  at.sign == Sign::open_list ? "zonedata of one's own is not in the subset: write fine or z0 .. z200"
                                             : "write fine, or z0 .. z200");
    return std::nullopt;
  }
  lexer_.advance();
  const std::optional<Zone> zone = predefined_zone(at.text);
  known = zone.has_value();
  if (zone) return zone;
  values_.error(at, fmt::format("the zone {} is not in the subset", shown(at)),
                "write fine, z0, z1, z5, z10, z15, z20, z30, z40, z50, z60, z80, z100, z150 or z200");
  return Zone{};
}

// tool0, wobj0.
bool Parser::read_frame(std::string_view type, std::string_view only) {
  const Token at = lexer_.token();
  if (at.kind != TokenKind::word) {
    values_.error(at, fmt::format("the {} is missing before {}", type, shown(at)), fmt::format("write {}", only));
    return false;
  }
  lexer_.advance();
  if (equal_ignoring_case(at.text, only)) return true;
  const Declared* const declared = names_.find(at.text);
  if (declared == nullptr || declared->storage != Declared::Storage::unusable) {
    values_.error(at, fmt::format("the {} {} is not in the subset", type, shown(at)),
                  fmt::format("teach the robtargets with {}", only));
    names_.forgive(at.text);
  }
  return true;
}

// \Name or \Name:=value, as often as it is there. False where reading cannot go on.
bool Parser::refuse_switches(bool work_object_allowed) {
  while (lexer_.at(Sign::backslash)) {
    lexer_.advance();
    const Token name = lexer_.token();
    if (name.kind != TokenKind::word) {
      values_.error(name, fmt::format("the name of a switch is missing before {}", shown(name)), "delete the '\\'");
      return false;
    }
    lexer_.advance();
    if (work_object_allowed && name.is("WOBJ")) {
      if (!values_.expect(Sign::becomes, ":=") || !read_frame("work object", "wobj0")) return false;
      continue;
    }
    values_.error(name, fmt::format("the switch \\{} is not in the subset", printable(name.text, 40)), "delete it");
    if (lexer_.at(Sign::becomes)) skip_switch_value();
  }
  return true;
}

void Parser::skip_switch_value() {
  while (!lexer_.at_end() && !lexer_.at(Sign::comma) && !lexer_.at(Sign::semicolon) && !lexer_.at(Sign::backslash)) {
    lexer_.advance();
  }
}

}  // namespace cellmirror::program::rapid
