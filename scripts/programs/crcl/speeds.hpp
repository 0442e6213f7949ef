// Speeds, accelerations and tolerances of CRCL: modal settings, and overrides of a single pose.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "scripts/programs/crcl/fields.hpp"
#include "scripts/programs/program/program.hpp"

namespace cellmirror::crcl {

enum class Limit : std::uint8_t { linear_velocity, linear_acceleration, rotational_velocity, rotational_acceleration };
inline constexpr std::size_t kLimits = 4;

// A value in SI, or a share of the robot's own.
struct LimitValue {
  double value = 0;
  bool share = false;
  bool operator==(const LimitValue&) const = default;
};
using Limits = std::array<std::optional<LimitValue>, kLimits>;

// What sets one limit: element and types of CRCL, settings of ours.
struct LimitName {
  Limit limit;
  std::string_view element;   // TransSpeed; the command is SetTransSpeedType
  std::string_view absolute;  // TransSpeedAbsoluteType: <Setting>
  std::string_view relative;  // TransSpeedRelativeType: <Fraction>
  program::Setting setting;
  program::Setting share;
  std::optional<program::Setting> joints;  // what a fraction means for moves that are not straight
  bool angle = false;
};
[[nodiscard]] const std::array<LimitName, kLimits>& limit_names();

// The value of <TransSpeed xsi:type="..."> and its three like.
[[nodiscard]] std::optional<LimitValue> read_limit(const Fields& fields, const XmlNode& node, const LimitName& name,
                                                   const Units& units);

// How far from a way point the next segment may begin, m: the smallest of the tolerances of its point. None: the
// robot's own. Angles do not count.
[[nodiscard]] std::optional<double> read_tolerance(const Fields& fields, const XmlNode& node, const Units& units);

}  // namespace cellmirror::crcl
