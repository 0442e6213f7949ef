#include "scripts/programs/program/value.hpp"

#include <fmt/format.h>

#include <array>

#include "rt_core/base/units.hpp"

namespace cellmirror::program {

namespace {

// What a value becomes SI with.
struct Factors {
  double turning = 1;
  double sliding = 1;
};

Factors factors_of(JointUnits units) {
  constexpr double kMPerInch = 0.0254;
  constexpr std::array<Factors, 6> kFactors = {
      {{1, 1}, {kRadPerDeg, kMPerMm}, {kRadPerDeg, 1}, {kRadPerDeg, kMPerInch}, {1, kMPerMm}, {1, kMPerInch}}};
  return kFactors.at(static_cast<std::size_t>(units));
}

}  // namespace

JointUnits joint_units(std::uint32_t payload) {
  const bool known = payload <= static_cast<std::uint32_t>(JointUnits::radian_inch);
  return known ? static_cast<JointUnits>(payload) : JointUnits::si;
}

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
  const Factors factors = factors_of(position.units);
  for (std::size_t joint = 0; joint < position.count; ++joint) {
    const double factor = kinds[joint] == JointKind::prismatic ? factors.sliding : factors.turning;
    values[joint] = position.values[joint] * factor;
  }
  return values;
}

JointPosition joint_position(const JointValues& values, std::span<const JointKind> kinds, JointUnits units) {
  JointPosition position;
  position.units = units;
  const Factors factors = factors_of(units);
  for (std::size_t joint = 0; joint < kinds.size() && joint < kMaxJointsPerRobot; ++joint) {
    position.values[joint] = values[joint] / (kinds[joint] == JointKind::prismatic ? factors.sliding : factors.turning);
    ++position.count;
  }
  return position;
}

}  // namespace cellmirror::program
