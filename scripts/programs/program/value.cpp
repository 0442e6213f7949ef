#include "scripts/programs/program/value.hpp"

#include <fmt/format.h>

#include <array>

#include "rt_core/base/units.hpp"

namespace cellmirror::program {

std::string_view name_of(ValueType type) {
  constexpr std::array<std::string_view, 5> kNames = {"a boolean", "an integer", "a real", "a pose", "joint values"};
  return kNames.at(static_cast<std::size_t>(type));
}

Value default_value(ValueType type) {
  switch (type) {
    case ValueType::boolean:
      return false;
    case ValueType::integer:
      return std::int64_t{0};
    case ValueType::real:
      return 0.0;
    case ValueType::pose:
      return Pose::Identity();
    case ValueType::joints:
      return JointPosition{};
  }
  return false;
}

Result<JointValues> joint_values_si(const JointPosition& position, std::span<const JointKind> kinds) {
  if (position.count > kinds.size()) {
    return fail(fmt::format("{} joint values for a robot with {} joints", position.count, kinds.size()));
  }
  JointValues values{};
  for (std::size_t joint = 0; joint < position.count; ++joint) {
    const double value = position.values[joint];
    const double factor = kinds[joint] == JointKind::prismatic ? kMPerMm : kRadPerDeg;
    values[joint] = position.units == JointUnits::si ? value : value * factor;
  }
  return values;
}

JointPosition joint_position(const JointValues& values, std::span<const JointKind> kinds, JointUnits units) {
  JointPosition position;
  position.units = units;
  for (std::size_t joint = 0; joint < kinds.size() && joint < kMaxJointsPerRobot; ++joint) {
    const double value = values[joint];
    const double in_degree_mm = kinds[joint] == JointKind::prismatic ? mm_from_m(value) : deg_from_rad(value);
    position.values[joint] = units == JointUnits::si ? value : in_degree_mm;
    ++position.count;
  }
  return position;
}

}  // namespace cellmirror::program
