#include "app/new_cell/signal_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <string_view>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/base/units.hpp"

namespace cellmirror::app {

namespace {

struct UnitOfSignal {
  std::string_view text;  // lower case
  JointQuantity quantity;
  double scale;  // to SI
};
constexpr double kRadPerTurn = 2.0 * std::numbers::pi;
constexpr std::array<UnitOfSignal, 18> kUnits{{{"rad", JointQuantity::position, 1.0},
                                               {"deg", JointQuantity::position, kRadPerDeg},
                                               {"degree", JointQuantity::position, kRadPerDeg},
                                               {"\xC2\xB0", JointQuantity::position, kRadPerDeg},
                                               {"\xB0", JointQuantity::position, kRadPerDeg},
                                               {"rev", JointQuantity::position, kRadPerTurn},
                                               {"turn", JointQuantity::position, kRadPerTurn},
                                               {"m", JointQuantity::position, 1.0},
                                               {"mm", JointQuantity::position, kMPerMm},
                                               {"rad/s", JointQuantity::velocity, 1.0},
                                               {"deg/s", JointQuantity::velocity, kRadPerDeg},
                                               {"rev/s", JointQuantity::velocity, kRadPerTurn},
                                               {"rpm", JointQuantity::velocity, kRadPerTurn / 60.0},
                                               {"1/min", JointQuantity::velocity, kRadPerTurn / 60.0},
                                               {"m/s", JointQuantity::velocity, 1.0},
                                               {"mm/s", JointQuantity::velocity, kMPerMm},
                                               {"nm", JointQuantity::effort, 1.0},
                                               {"n*m", JointQuantity::effort, 1.0}}};

bool has_word(std::string_view text, std::initializer_list<std::string_view> words) {
  return std::ranges::any_of(words, [&](std::string_view word) { return text.find(word) != std::string_view::npos; });
}

struct Kind {
  JointQuantity quantity;
  double scale;
};

// What the name and the unit say together; nothing where they say it of no joint's measured value.
std::optional<Kind> kind_of(const can::DbcMessage& message, const can::DbcSignal& signal) {
  const std::string name = lower_case(signal.name);
  const std::string whole = lower_case(message.name) + "." + name;
  if (has_word(whole, {"cmd", "command", "target", "setpoint", "set_", "desired", "demand", "request", "limit", "max",
                       "min_", "offset", "error", "input", "sensorless"}))
    return std::nullopt;
  if (signal.is_multiplexer || has_word(name, {"counter", "crc", "checksum", "temp", "radius", "count"}))
    return std::nullopt;
  const std::string unit = lower_case(trimmed(signal.unit));
  const auto known = std::ranges::find(kUnits, std::string_view(unit), &UnitOfSignal::text);
  const bool velocity = has_word(name, {"vel", "speed"});
  const bool position = !velocity && has_word(name, {"pos", "angle", "angular"});
  if (known != kUnits.end()) {
    const bool contradicts = (velocity && known->quantity != JointQuantity::velocity) ||
                             (position && known->quantity != JointQuantity::position);
    // A length alone is no position of a joint: it may be the size of anything.
    const bool vague = !position && (unit == "m" || unit == "mm");
    if (contradicts || vague || known->quantity == JointQuantity::effort) return std::nullopt;
    return Kind{known->quantity, known->scale};
  }
  if (!unit.empty()) return std::nullopt;
  if (velocity) return Kind{JointQuantity::velocity, 1.0};
  if (position) return Kind{JointQuantity::position, 1.0};
  return std::nullopt;
}

// The longest common beginning, without regard to case: "TurnSpeed" belongs to "TurnAngle".
std::size_t common_beginning(std::string_view a, std::string_view b) {
  const std::size_t most = std::min(a.size(), b.size());
  std::size_t n = 0;
  while (n < most && equal_ignoring_case(a.substr(n, 1), b.substr(n, 1))) ++n;
  return n;
}

}  // namespace

GuessedSignals guess_signals(const can::Dbc& dbc) {
  GuessedSignals out;
  std::vector<PlannedSignal> velocities;
  for (const can::DbcMessage& message : dbc.messages) {
    for (const can::DbcSignal& signal : message.signals) {
      const auto kind = kind_of(message, signal);
      PlannedSignal planned{message.name,
                            signal.name,
                            0,
                            kind ? kind->quantity : JointQuantity::position,
                            kind ? kind->scale : 1.0,
                            signal.unit,
                            signal.is_multiplexed};
      if (kind && kind->quantity == JointQuantity::position && out.joints < kMaxJointsPerRobot) {
        planned.joint = out.joints++;
        out.signals.push_back(std::move(planned));
      } else if (kind && kind->quantity == JointQuantity::velocity) {
        velocities.push_back(std::move(planned));
      } else if (out.others.size() < kMostOthers) {
        out.others.push_back(fmt::format("{}.{} [{}]", message.name, signal.name, signal.unit));
      }
    }
  }
  const std::size_t positions = out.signals.size();
  std::vector<bool> taken(positions, false);
  for (PlannedSignal& velocity : velocities) {
    std::size_t best = positions;
    std::size_t longest = 0;
    for (std::size_t i = 0; i < positions; ++i) {
      const PlannedSignal& position = out.signals[i];
      // A shared message counts more than any name.
      constexpr std::size_t kSameMessage = 1000;
      const std::size_t common = common_beginning(position.signal, velocity.signal) +
                                 (position.message == velocity.message ? kSameMessage : 0);
      constexpr std::size_t kEnough = 3;
      if (!taken[i] && common >= kEnough && common > longest) {
        best = i;
        longest = common;
      }
    }
    if (best == positions) continue;
    taken[best] = true;
    velocity.joint = best;
    out.signals.push_back(velocity);
  }
  return out;
}

}  // namespace cellmirror::app
