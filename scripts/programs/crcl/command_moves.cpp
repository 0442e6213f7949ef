// The commands of CRCL that move.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "rt_core/base/text.hpp"
#include "scripts/programs/crcl/command_reader.hpp"

namespace cellmirror::crcl {

using program::ExpressionId;
using program::JointUnits;
using program::MoveStatement;
using program::Operator;
using program::PathKind;
using program::SetStatement;
using program::Setting;
using program::TargetKind;

void CommandReader::put_limits(const Fields& fields, const XmlNode& node, const Limits& wanted) {
  for (const LimitName& name : limit_names()) {
    const auto index = static_cast<std::size_t>(name.limit);
    const std::optional<LimitValue>& value = wanted.at(index);
    if (value == limits_in_force_.at(index)) continue;
    limits_in_force_.at(index) = value;
    const auto set = [&](Setting setting, bool given) {
      add(fields, node, SetStatement{setting, given ? builder_.real(value->value) : program::kNoExpression});
    };
    const bool share = value && value->share;
    set(share ? name.share : name.setting, value.has_value());
    if (name.joints) set(*name.joints, share);
  }
}

void CommandReader::put_fly(const Fields& fields, const XmlNode& node, std::optional<double> distance_m) {
  if (distance_m == fly_in_force_m_) return;
  fly_in_force_m_ = distance_m;
  add(fields, node,
      SetStatement{Setting::fly_distance, distance_m ? builder_.real(*distance_m) : program::kNoExpression});
}

Limits CommandReader::read_overrides(const Fields& fields, const XmlNode& node,
                                     std::optional<double>& tolerance_m) const {
  Limits wanted = limits_;
  if (node.type != "PoseAndSetType") {
    fields.only(node, {"Point", "XAxis", "ZAxis"});
    return wanted;
  }
  fields.only(node, {"Point", "XAxis", "ZAxis", "Coordinated", "TransSpeed", "RotSpeed", "TransAccel", "RotAccel",
                     "Tolerance"});
  static_cast<void>(fields.boolean(node, "Coordinated"));
  for (const LimitName& name : limit_names()) {
    const XmlNode* value = fields.optional(node, name.element);
    if (value != nullptr) wanted.at(static_cast<std::size_t>(name.limit)) = read_limit(fields, *value, name, units_);
  }
  if (const XmlNode* tolerance = fields.optional(node, "Tolerance")) {
    tolerance_m = read_tolerance(fields, *tolerance, units_);
  }
  return wanted;
}

void CommandReader::move_to_pose(const Fields& fields, const XmlNode& node, bool straight, bool through) {
  if (!node.type.empty() && node.type != "PoseType" && node.type != "PoseAndSetType") {
    return fields.error(node, fmt::format("'{}' is not a pose type", printable(node.type)),
                        "PoseType or PoseAndSetType");
  }
  std::optional<double> tolerance_m = through_tolerance_m_;
  const Limits wanted = read_overrides(fields, node, tolerance_m);
  const auto X_ZT = fields.pose(node, units_);
  if (!X_ZT) return;
  put_limits(fields, node, wanted);
  if (through) put_fly(fields, node, tolerance_m);
  add(fields, node,
      MoveStatement{.path = straight ? PathKind::linear : PathKind::joints,
                    .kind = TargetKind::pose_absolute,
                    .fly = through,
                    .target = builder_.constant(*X_ZT)});
}

void CommandReader::move_to(const Fields& fields, const XmlNode& node) {
  fields.only(node, {"CommandID", "MoveStraight", "EndPosition"});
  const auto straight = fields.boolean(node, "MoveStraight");
  const XmlNode* end = fields.required(node, "EndPosition");
  if (end != nullptr) move_to_pose(fields, *end, straight.value_or(true), false);
}

void CommandReader::move_through_to(const Fields& fields, const XmlNode& node) {
  fields.only(node, {"CommandID", "MoveStraight", "Waypoint", "NumPositions"}, "Waypoint");
  const auto straight = fields.boolean(node, "MoveStraight");
  const auto count = fields.positive_integer(node, "NumPositions");
  std::vector<const XmlNode*> points;
  for (const XmlNode* one = fields.tree().first(node); one != nullptr; one = fields.tree().next(*one)) {
    if (one->name == "Waypoint") points.push_back(one);
  }
  if (points.size() < 2) fields.error(node, "a move through way points needs at least two");
  if (count && static_cast<std::size_t>(*count) != points.size()) {
    fields.error(node, fmt::format("<NumPositions> is {}, and there are {} way points", *count, points.size()));
  }
  for (const XmlNode* point : points) {
    move_to_pose(fields, *point, straight.value_or(true), point != points.back());
  }
}

// Turning by more than half a turn goes by quarters at most, since a pose alone does not say how often it was turned.
void CommandReader::add_screw(const Fields& fields, const XmlNode& node, double distance_m, double turn_rad) {
  const double steps = std::max(1.0, std::ceil(std::abs(turn_rad) / (std::numbers::pi / 2) - 1e-9));
  put_limits(fields, node, limits_);
  for (int step = 0; step < static_cast<int>(steps); ++step) {
    const Pose X_TT = pose_from_xyz_rpy({0, 0, distance_m / steps}, {0, 0, turn_rad / steps});
    add(fields, node,
        MoveStatement{.path = PathKind::linear,
                      .kind = TargetKind::tool_relative,
                      .fly = step + 1 < static_cast<int>(steps),
                      .target = builder_.constant(X_TT)});
  }
}

void CommandReader::move_screw(const Fields& fields, const XmlNode& node) {
  fields.only(node, {"CommandID", "StartPosition", "AxisPoint", "AxialDistanceFree", "AxialDistanceScrew", "Turn"});
  if (const XmlNode* axis = fields.optional(node, "AxisPoint")) {
    fields.error(*axis, "a screw motion about another axis than that of the TCP is not supported");
  }
  const auto distance = fields.number(node, "AxialDistanceScrew");
  const auto turn = fields.number(node, "Turn");
  const XmlNode* free_node = fields.optional(node, "AxialDistanceFree");
  const auto free = free_node == nullptr ? std::optional(0.0) : fields.number(*free_node);
  if (const XmlNode* start = fields.optional(node, "StartPosition")) move_to_pose(fields, *start, false, false);
  if (!distance || !turn || !free) return;
  constexpr double kMostTurns = 1000;
  const double turn_rad = *turn * units_.rad();
  if (std::abs(turn_rad) > kMostTurns * 2 * std::numbers::pi) {
    return fields.error(node, fmt::format("a screw motion of more than {} turns", kMostTurns));
  }
  if (*free != 0) add_screw(fields, node, *free * units_.metres(), 0);
  add_screw(fields, node, *distance * units_.metres(), turn_rad);
}

program::JointUnits CommandReader::joint_units() const {
  const bool degree = units_.angle == AngleUnit::degree;
  if (units_.length == LengthUnit::metre) return degree ? JointUnits::degree_m : JointUnits::si;
  if (units_.length == LengthUnit::inch) return degree ? JointUnits::degree_inch : JointUnits::radian_inch;
  return degree ? JointUnits::degree_mm : JointUnits::radian_mm;
}

// By joint, from the first to the last that is named.
CommandReader::Joints CommandReader::read_joints(const Fields& fields, const XmlNode& node) {
  Joints joints;
  for (const XmlNode* one = fields.tree().first(node); one != nullptr; one = fields.tree().next(*one)) {
    if (one->name != "ActuateJoint") continue;
    fields.only(*one, {"JointNumber", "JointPosition", "JointDetails"});
    const auto number = fields.positive_integer(*one, "JointNumber");
    const auto position = fields.number(*one, "JointPosition");
    const XmlNode* details = fields.required(*one, "JointDetails");
    const bool any = details != nullptr && fields.tree().first(*details) != nullptr;
    if (any && !std::exchange(told_joint_speeds_, true)) {
      fields.warning(*one, "speeds and forces of single joints have no effect: the robot's own apply",
                     "SetTransSpeed with a fraction slows all joints down");
    }
    if (!number || !position) continue;
    if (*number > static_cast<long long>(kMaxJointsPerRobot)) {
      fields.error(*one, fmt::format("joint {}: robots have at most {}", *number, kMaxJointsPerRobot));
      continue;
    }
    const auto index = static_cast<std::size_t>(*number - 1);
    if (index >= joints.size()) joints.resize(index + 1);
    if (joints[index]) fields.error(*one, fmt::format("joint {} is given twice", *number));
    joints[index] = position;
  }
  return joints;
}

// Joints that are not named stay where they are.
Result<ExpressionId> CommandReader::joint_target(const Joints& joints) {
  const auto units = static_cast<std::uint32_t>(joint_units());
  std::vector<ExpressionId> values;
  for (std::uint32_t index = 0; index < joints.size(); ++index) {
    if (joints[index]) {
      values.push_back(builder_.real(*joints[index]));
      continue;
    }
    const auto now = builder_.operation(Operator::current_joints, std::span<const ExpressionId>{}, units);
    if (!now) return now;
    const auto value = builder_.operation(Operator::component, {*now}, index);
    if (!value) return value;
    values.push_back(*value);
  }
  return builder_.operation(Operator::make_joints, values, units);
}

void CommandReader::actuate_joints(const Fields& fields, const XmlNode& node) {
  fields.only(node, {"CommandID", "ActuateJoint"}, "ActuateJoint");
  const Joints joints = read_joints(fields, node);
  if (joints.empty()) {
    if (fields.optional(node, "ActuateJoint") == nullptr) fields.error(node, "<ActuateJoint> is missing");
    return;
  }
  put_limits(fields, node, limits_);
  const auto target = joint_target(joints);
  if (!target) return fields.error(node, target.error().what);
  add(fields, node, MoveStatement{.target = *target});
}

}  // namespace cellmirror::crcl
