#include "scripts/programs/crcl/speeds.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rt_core/base/text.hpp"

namespace cellmirror::crcl {

using program::Setting;

const std::array<LimitName, kLimits>& limit_names() {
  static const std::array<LimitName, kLimits> names = {{
      {Limit::linear_velocity, "TransSpeed", "TransSpeedAbsoluteType", "TransSpeedRelativeType",
       Setting::linear_velocity, Setting::linear_velocity_share, Setting::joint_velocity, false},
      {Limit::linear_acceleration, "TransAccel", "TransAccelAbsoluteType", "TransAccelRelativeType",
       Setting::linear_acceleration, Setting::linear_acceleration_share, Setting::joint_acceleration, false},
      {Limit::rotational_velocity, "RotSpeed", "RotSpeedAbsoluteType", "RotSpeedRelativeType",
       Setting::rotational_velocity, Setting::rotational_velocity_share, std::nullopt, true},
      {Limit::rotational_acceleration, "RotAccel", "RotAccelAbsoluteType", "RotAccelRelativeType",
       Setting::rotational_acceleration, Setting::rotational_acceleration_share, std::nullopt, true},
  }};
  return names;
}

std::optional<LimitValue> read_limit(const Fields& fields, const XmlNode& node, const LimitName& name,
                                     const Units& units) {
  if (node.type != name.absolute && node.type != name.relative) {
    fields.error(node, fmt::format("<{}> has no known xsi:type, '{}'", name.element, printable(node.type)),
                 fmt::format("{} or {}", name.absolute, name.relative));
    return std::nullopt;
  }
  const bool share = node.type == name.relative;
  const std::string_view field = share ? "Fraction" : "Setting";
  fields.only(node, {field});
  const XmlNode* value_node = fields.required(node, field);
  if (value_node == nullptr) return std::nullopt;
  const auto value = share ? fields.fraction(*value_node) : fields.number(*value_node);
  if (!value) return std::nullopt;
  if (*value <= 0) {
    fields.error(*value_node, fmt::format("<{}> must be above 0", field));
    return std::nullopt;
  }
  const double unit = name.angle ? units.rad() : units.metres();
  return LimitValue{.value = share ? *value : *value * unit, .share = share};
}

std::optional<double> read_tolerance(const Fields& fields, const XmlNode& node, const Units& units) {
  fields.only(node, {"XPointTolerance", "YPointTolerance", "ZPointTolerance", "XAxisTolerance", "ZAxisTolerance"});
  std::optional<double> smallest;
  for (const XmlNode* one = fields.tree().first(node); one != nullptr; one = fields.tree().next(*one)) {
    if (one->name == "Name") continue;
    const auto value = fields.number(*one);
    if (!value) continue;
    if (*value < 0) {
      fields.error(*one, "a tolerance must not be negative");
      continue;
    }
    const bool of_point =
        one->name == "XPointTolerance" || one->name == "YPointTolerance" || one->name == "ZPointTolerance";
    if (of_point) smallest = std::min(smallest.value_or(*value * units.metres()), *value * units.metres());
  }
  return smallest;
}

}  // namespace cellmirror::crcl
