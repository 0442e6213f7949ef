// What the values of a mirrored robot may be: the bounds that the cell file implies, and what was found beyond them.
// Plain data; of fixed size, so that the tick may use it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

// Why a value is implausible.
enum class Implausibility : std::uint8_t {
  none,
  position,      // beyond the joint's range and its margin
  velocity,      // moved, or says that it moves, faster than the joint can
  acceleration,  // its own velocity changed faster than the joint can
  frozen,        // equal to the last bit for too long
};

// What a robot file says that the joint can do. Infinite: nothing is known. SI: rad or m, and their derivatives.
struct KnownLimits {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double velocity = std::numeric_limits<double>::infinity();
  double acceleration = std::numeric_limits<double>::infinity();
};

// What a cell file says about the check of a stream's values; the defaults are those of docs/plausibility.md.
struct PlausibilityConfig {
  bool enabled = true;
  double position_margin = 0.1;       // share of the joint's range that it may leave it by, on each side
  double velocity_factor = 1.5;       // times the joint's velocity; 0: velocities are not checked
  double acceleration_factor = 10.0;  // the same; brakes and collisions stop a joint faster than its drive
  // A value may have been this much longer under way than the one before: receipt is not the instant of measurement.
  Nanoseconds arrival_jitter{50'000'000};
  Nanoseconds frozen_after{0};  // 0: standing still to the last bit is plausible
  std::uint16_t plausible_after = 10;
};

// What the tick checks the values of one robot against.
struct PlausibilityBounds {
  std::array<KnownLimits, kMaxJointsPerRobot> joints{};
  Nanoseconds arrival_jitter{50'000'000};
  Nanoseconds frozen_after{0};        // 0: not checked
  std::uint16_t plausible_after = 1;  // values in succession that have to be plausible before one is shown again; >= 1
};

// The bounds of one joint. A range whose ends are no ends (continuous joints) is none.
[[nodiscard]] constexpr KnownLimits bounds_of(const KnownLimits& known, const PlausibilityConfig& config) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!config.enabled) return {};
  const double width = known.upper - known.lower;
  const double margin = width < kInfinity ? config.position_margin * width : 0.0;
  return {
      .lower = known.lower - margin,
      .upper = known.upper + margin,
      .velocity = config.velocity_factor > 0.0 ? config.velocity_factor * known.velocity : kInfinity,
      .acceleration = config.acceleration_factor > 0.0 ? config.acceleration_factor * known.acceleration : kInfinity};
}

// The newest implausible value of a robot.
struct ImplausibleValue {
  Implausibility why = Implausibility::none;
  std::uint8_t joint = 0;
  double value = 0;  // rad, rad/s, rad/s2 (m, ...) by `why`; frozen: s without change
  double bound = 0;  // what it would have to be within, in the same unit
  Timestamp receive_time;
};

}  // namespace cellmirror
