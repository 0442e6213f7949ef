// What the reader, the writer and the recorder of teach files share. The dialects are ours (docs/languages/jet.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::program {

enum class TeachDialect : std::uint8_t {
  boom,  // a check point has a value for every joint
  tarm,  // a check point names the joints that it moves; the others stay where the check point before has them
};

inline constexpr int kTeachVersion = 1;
inline constexpr std::size_t kLongestTeachLine = 4096;     // bytes
inline constexpr double kGreatestTeachValue = 1e6;         // degrees or mm, of either sign
inline constexpr double kLongestTeachDwell = 86'400;       // s
inline constexpr double kGreatestTeachDistance = 100'000;  // mm; tolerance
inline constexpr double kGreatestTeachAngle = 180;         // degrees; tolerance

// The first word of a file, and the language's name in ROBOT_LANGUAGE.
[[nodiscard]] constexpr std::string_view header_of(TeachDialect dialect) {
  return dialect == TeachDialect::boom ? "JET_BOOM" : "JET_TARM";
}
[[nodiscard]] constexpr std::string_view language_of(TeachDialect dialect) {
  return dialect == TeachDialect::boom ? "jet_boom" : "jet_tarm";
}

// Distance to a check point at which the robot may continue to the next one. The units of FlyType: m, rad, or the
// fraction of the speed below which it has dropped.
struct TeachTolerance {
  FlyType type = FlyType::distance;
  double parameter = 0;
  bool operator==(const TeachTolerance&) const = default;
};

// A letter, then letters, digits, '_', '-' and '.'; at most kMaxNameLength bytes.
[[nodiscard]] bool is_teach_name(std::string_view text);

}  // namespace cellmirror::program
