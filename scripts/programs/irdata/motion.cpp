// Motions, offsets, speeds and accelerations, fly-by.
#include <fmt/format.h>

#include "rt_core/base/units.hpp"
#include "scripts/programs/irdata/translator.hpp"

namespace cellmirror::program::irdata {

namespace {

TargetKind kind_of_target(int family, ValueType type) {
  const bool joints = type == ValueType::joints;
  if (family == 0) return joints ? TargetKind::joints_absolute : TargetKind::pose_absolute;
  if (family == 1) return joints ? TargetKind::joints_relative : TargetKind::pose_relative;
  return TargetKind::tool_relative;
}

}  // namespace

void Translator::motion_record() {
  const int index = static_cast<int>(operation_) - static_cast<int>(Operation::ptp);
  MoveStatement move;
  move.path = static_cast<PathKind>(index % 3);
  const int family = index / 3;  // absolute, relative, along the axes of the TCP
  Term via;
  if (move.path == PathKind::circular) via = value_parameter();
  const Term target = value_parameter();
  move.fly = word_parameter(Word::fly);
  cursor_.skip_blank();
  const auto is_target = [](const Term& term) {
    return term.type == ValueType::pose || term.type == ValueType::joints;
  };
  bool good = true;
  for (const Term* point : {static_cast<const Term*>(&via), &target}) {
    if (!point->known || is_target(*point)) continue;
    findings_.error(point->column, fmt::format("a robot cannot move to {}", with_article(point->type)),
                    "write POSE(...), JOINTS(...) or a variable of these types");
    good = false;
  }
  if (!good || !target.known || (move.path == PathKind::circular && !via.known)) return;
  if (move.path == PathKind::circular && via.type != target.type) {
    findings_.error(
        target.column,
        fmt::format("the via point is {} and the target {}", with_article(via.type), with_article(target.type)),
        "write both as poses or both as joint values");
    return;
  }
  if (family == 2 && target.type == ValueType::joints) {
    findings_.error(target.column, "joint values have no axes of the TCP",
                    "write a pose, or use PTP_INC for joint values");
    return;
  }
  move.kind = kind_of_target(family, target.type);
  if (via.known) move.via = terms_.id(via);
  move.target = terms_.id(target);
  add(move, target.column);
}

// A setting that is a positive number; DEFAULT (then unknown) has been checked before.
Term Translator::scaled_setting(std::string_view what, double greatest, double factor) {
  const Term term = typed_parameter(what, ValueType::real);
  const auto value = terms_.constant_number(term);
  if (value && (!(*value > 0) || *value > greatest)) {
    findings_.error(term.column, fmt::format("{} cannot be {}", what, *value),
                    greatest < 1e6 ? fmt::format("write more than 0 and up to {}", greatest)
                                   : "write more than 0, in the unit of the record");
    return {};
  }
  return terms_.scaled(term, factor);
}

void Translator::setting_record() {
  if (operation_ == Operation::fly) return fly_record();
  SetStatement set;
  const bool back = word_parameter(Word::default_word);
  Term value;
  const std::uint32_t column = operation_column_;
  constexpr double kGreatest = 1e9;
  switch (operation_) {
    case Operation::tcp:
      set.setting = Setting::tool;
      if (!back) value = typed_parameter("a TCP", ValueType::pose);
      break;
    case Operation::zero_point:
      set.setting = Setting::zero_point;
      if (!back) value = typed_parameter("a zero point", ValueType::pose);
      break;
    case Operation::vel_joint:
      set.setting = Setting::joint_velocity;
      if (!back) value = scaled_setting("a speed in percent", 100, 0.01);
      break;
    case Operation::acc_joint:
      set.setting = Setting::joint_acceleration;
      if (!back) value = scaled_setting("an acceleration in percent", 100, 0.01);
      break;
    case Operation::vel_lin:
      set.setting = Setting::linear_velocity;
      if (!back) value = scaled_setting("a speed", kGreatest, kMPerMm);
      break;
    case Operation::acc_lin:
      set.setting = Setting::linear_acceleration;
      if (!back) value = scaled_setting("an acceleration", kGreatest, kMPerMm);
      break;
    case Operation::vel_rot:
      set.setting = Setting::rotational_velocity;
      if (!back) value = scaled_setting("a speed", kGreatest, kRadPerDeg);
      break;
    default:
      set.setting = Setting::rotational_acceleration;
      if (!back) value = scaled_setting("an acceleration", kGreatest, kRadPerDeg);
      break;
  }
  if (!back && !value.known) return;
  if (!back) set.value = terms_.id(value);
  add(set, column);
}

void Translator::fly_record() {
  SetStatement set;
  set.setting = Setting::fly_distance;
  if (word_parameter(Word::default_word)) return add(set, operation_column_);
  constexpr double kGreatestDistance = 1e9;
  Term value;
  if (word_parameter(Word::distance)) {
    value = scaled_setting("a fly distance", kGreatestDistance, kMPerMm);
  } else if (word_parameter(Word::speed)) {
    set.setting = Setting::fly_speed_fraction;
    value = scaled_setting("a fly speed in percent", 100, 0.01);
  } else if (word_parameter(Word::angle)) {
    set.setting = Setting::fly_angle;
    value = scaled_setting("a fly angle in degrees", 180, kRadPerDeg);
  } else if (require_parameter()) {
    findings_.error(cursor_.column(), "a fly point is given by SPEED, DISTANCE or ANGLE",
                    "write " + form_of(operation_));
    incomplete_ = true;
  }
  if (!value.known) return;
  set.value = terms_.id(value);
  add(set, operation_column_);
}

}  // namespace cellmirror::program::irdata
