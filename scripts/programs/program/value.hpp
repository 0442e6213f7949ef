// Values of robot programs.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <variant>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/robot_parameters.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror::program {

// Units of joint values. The kinds of joints depend on the robot, so joint values become SI only when the machine emits
// a command.
enum class JointUnits : std::uint8_t {
  si,         // rad and m
  degree_mm,  // degrees and mm, as in SCRIPT
  degree_m,
  degree_inch,
  radian_mm,
  radian_inch,
};
// Of an operator's payload.
[[nodiscard]] JointUnits joint_units(std::uint32_t payload);

// The first `count` joints of a robot.
struct JointPosition {
  JointValues values{};
  std::uint8_t count = 0;
  JointUnits units = JointUnits::degree_mm;
};

enum class ValueType : std::uint8_t { boolean, integer, real, pose, joints };
[[nodiscard]] std::string_view name_of(ValueType type);

// In the order of ValueType. Reals have the unit that their use says (mm or m are the language's affair: poses are in
// metres always).
using Value = std::variant<bool, std::int64_t, double, Pose, JointPosition>;
[[nodiscard]] inline ValueType type_of(const Value& value) { return static_cast<ValueType>(value.index()); }
// false, 0, 0.0, the identity, no joints.
[[nodiscard]] Value default_value(ValueType type);

// rad and m, by the kinds of the robot's joints. Refused: more values than the robot has joints.
[[nodiscard]] Result<JointValues> joint_values_si(const JointPosition& position, std::span<const JointKind> kinds);
// The first kinds.size() of `values` (rad or m) in these units.
[[nodiscard]] JointPosition joint_position(const JointValues& values, std::span<const JointKind> kinds,
                                           JointUnits units);

}  // namespace cellmirror::program
