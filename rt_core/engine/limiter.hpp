// The checks that set points have to pass. Inside the tick only JointGate applies them; the owner of the cell uses
// check_setpoints() to refuse in time and with words.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "rt_core/base/real_time.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::engine {

enum class LimiterVerdict : std::uint8_t {
  passed,
  not_finite,
  beyond_limit,
  too_fast,
  beyond_acceleration,
  beyond_jerk,
};

// A value may exceed a limit of position by this [rad or m], which is what unit conversion costs.
inline constexpr double kLimitSlack = 1e-9;
// The same for what follows from positions of two ticks: a share of the limit, and kLimitSlack of the positions.
inline constexpr double kRateSlack = 1e-6;

[[nodiscard]] constexpr JointValues unlimited() {
  JointValues values{};
  values.fill(std::numeric_limits<double>::infinity());
  return values;
}

// Of the joints of one robot, in rad or m, and their derivatives by s. Infinite: not given.
struct JointLimits {
  JointValues lower{};
  JointValues upper{};
  JointValues velocity = unlimited();
  JointValues acceleration = unlimited();
  JointValues jerk = unlimited();
};

// Set points of one robot [rad or m] against its limits of position. All spans have the size of `positions`.
[[nodiscard]] LimiterVerdict check_setpoints(std::span<const double> positions, std::span<const double> lower,
                                             std::span<const double> upper) CELL_RT;

// How one joint moved in the tick before.
struct JointRate {
  double velocity = 0;      // rad/s or m/s, by the difference of its positions
  double acceleration = 0;  // rad/s2 or m/s2, likewise
};

// A step of one joint from `present` to `next` [rad or m] within `dt` seconds, after `before`. `now` is how it moves
// then; it is set where the step passed.
struct JointStep {
  double present = 0;
  double next = 0;
  double dt = 0;
  JointRate before = {};
};
struct RateLimits {
  double velocity = std::numeric_limits<double>::infinity();
  double acceleration = std::numeric_limits<double>::infinity();
  double jerk = std::numeric_limits<double>::infinity();
};
[[nodiscard]] LimiterVerdict check_step(const JointStep& step, const RateLimits& limits, JointRate& now) CELL_RT;

}  // namespace cellmirror::engine
