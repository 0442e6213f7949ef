// PTP, LIN, ZIR and what is set for them.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "rt_core/base/units.hpp"
#include "scripts/programs/srcl/keywords.hpp"
#include "scripts/programs/srcl/parser.hpp"

namespace cellmirror::program::srcl {

namespace {

constexpr double kShare = 0;  // percent, divided by 100

struct SettingRow {
  Keyword keyword;
  Setting setting;
  double si_factor;
  bool zero_allowed = false;
};

constexpr auto kSettings = std::to_array<SettingRow>({
    {Keyword::joint_velocity, Setting::joint_velocity, kShare},
    {Keyword::joint_acceleration, Setting::joint_acceleration, kShare},
    {Keyword::path_velocity, Setting::linear_velocity, kMPerMm},
    {Keyword::path_acceleration, Setting::linear_acceleration, kMPerMm},
    {Keyword::turn_velocity, Setting::rotational_velocity, kRadPerDeg},
    {Keyword::turn_acceleration, Setting::rotational_acceleration, kRadPerDeg},
    {Keyword::fly_distance, Setting::fly_distance, kMPerMm, true},
    {Keyword::fly_angle, Setting::fly_angle, kRadPerDeg, true},
    {Keyword::fly_speed, Setting::fly_speed_fraction, kShare, true},
});

constexpr double kWhole = 100;  // percent

std::string_view range_of(const SettingRow& row) {
  if (row.si_factor == kShare) return row.zero_allowed ? "0 to 100 percent" : "more than 0 and at most 100 percent";
  return row.zero_allowed ? "0 or more" : "more than 0";
}

bool in_range(const SettingRow& row, double value) {
  if (value < 0 || (value == 0 && !row.zero_allowed)) return false;
  return row.si_factor != kShare || value <= kWhole;
}

}  // namespace

std::optional<bool> Parser::motion_statement(const Token& at) {
  switch (at.keyword) {
    case Keyword::ptp:
      return move(PathKind::joints, at);
    case Keyword::linear:
      return move(PathKind::linear, at);
    case Keyword::circular:
      return move(PathKind::circular, at);
    case Keyword::joint_velocity:
    case Keyword::joint_acceleration:
    case Keyword::path_velocity:
    case Keyword::path_acceleration:
    case Keyword::turn_velocity:
    case Keyword::turn_acceleration:
    case Keyword::fly_distance:
    case Keyword::fly_angle:
    case Keyword::fly_speed:
    case Keyword::tool:
    case Keyword::zero_point:
      return setting(at);
    default:
      return std::nullopt;
  }
}

std::optional<Operand> Parser::read_target(TargetKind pose_kind, TargetKind joints_kind, TargetKind& kind) {
  const Token at = lexer_.token();
  const std::optional<Operand> target = expressions_.read();
  if (!target || !target->known()) return target;
  if (target->is(ValueType::pose)) {
    kind = pose_kind;
  } else if (target->is(ValueType::joints) && pose_kind != TargetKind::tool_relative) {
    kind = joints_kind;
  } else {
    const bool tool = pose_kind == TargetKind::tool_relative;
    faults_.add(
        at,
        fmt::format("a value of {} is not a target{}", word_of(target->type), tool ? " in the axes of the tool" : ""),
        tool ? "write a value of LAGE" : "write a value of LAGE or STELLUNG, as in LAGE(500, 0, 300)");
    return Operand{};
  }
  return target;
}

bool Parser::move(PathKind path, const Token& at) {
  TargetKind pose_kind = TargetKind::pose_absolute;
  TargetKind joints_kind = TargetKind::joints_absolute;
  if (lexer_.token().keyword == Keyword::relative) {
    pose_kind = TargetKind::pose_relative;
    joints_kind = TargetKind::joints_relative;
    lexer_.advance();
  } else if (lexer_.token().keyword == Keyword::tool_axes) {
    pose_kind = joints_kind = TargetKind::tool_relative;
    lexer_.advance();
  }
  MoveStatement statement;
  statement.path = path;
  std::optional<Operand> via;
  TargetKind via_kind = pose_kind;
  const Token first = lexer_.token();
  if (path == PathKind::circular) {
    via = read_target(pose_kind, joints_kind, via_kind);
    if (!via || !expressions_.expect(Sign::comma, ",")) return false;
  }
  const std::optional<Operand> target = read_target(pose_kind, joints_kind, statement.kind);
  if (!target) return false;
  if (lexer_.token().keyword == Keyword::fly) {
    statement.fly = true;
    lexer_.advance();
  }
  if (!target->known() || (via && !via->known())) return true;
  if (via && via_kind != statement.kind) {
    faults_.add(first, "the two points of ZIR are of different types", "write two values of LAGE, or two of STELLUNG");
    return true;
  }
  if (via) statement.via = emitter_.expression(*via);
  statement.target = emitter_.expression(*target);
  emitter_.add(statement, at);
  return true;
}

bool Parser::setting(const Token& at) {
  const bool frame = at.keyword == Keyword::tool || at.keyword == Keyword::zero_point;
  SetStatement statement;
  statement.setting = at.keyword == Keyword::tool ? Setting::tool : Setting::zero_point;
  const SettingRow* row = nullptr;
  if (!frame) {
    row = &*std::ranges::find(kSettings, at.keyword, &SettingRow::keyword);
    statement.setting = row->setting;
  }
  if (lexer_.token().keyword == Keyword::standard) {
    lexer_.advance();
    emitter_.add(statement, at);
    return true;
  }
  const Token value_at = lexer_.token();
  std::optional<Operand> value = expressions_.read(frame ? ValueType::pose : ValueType::real,
                                                   fmt::format("the value of {}", spelling(at.keyword)));
  if (!value) return false;
  if (!value->known()) return true;
  if (row != nullptr) {
    if (value->constant() && !in_range(*row, value->real)) {
      faults_.add(value_at, fmt::format("{} cannot be {}", spelling(at.keyword), value->real),
                  fmt::format("write a value of {}", range_of(*row)));
      return true;
    }
    if (row->si_factor != kShare) {
      value = emitter_.real(*value, row->si_factor);
    } else if (value->constant()) {
      value = Operand::of(value->real / kWhole);
    } else {
      value = emitter_.node(Operator::divide, ValueType::real, {*value, Operand::of(kWhole)});
    }
  }
  statement.value = emitter_.expression(*value);
  emitter_.add(statement, at);
  return true;
}

}  // namespace cellmirror::program::srcl
