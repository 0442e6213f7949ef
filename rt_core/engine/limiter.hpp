// The one choke point for every set point that the tick lets through.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/base/real_time.hpp"

namespace cellmirror::engine {

enum class LimiterVerdict : std::uint8_t { passed, not_finite, beyond_limit, too_fast };

// Set points of one robot [rad or m] against its limits. They pass as a whole or not at all, so that a robot is never
// sent to half of a posture. A value may exceed a limit by kLimitSlack, which is what unit conversion costs.
inline constexpr double kLimitSlack = 1e-9;
[[nodiscard]] LimiterVerdict check_setpoints(std::span<const double> positions, std::span<const double> lower,
                                             std::span<const double> upper) CELL_RT;

// Set points of a move besides: no joint further from where it stands than its velocity [rad/s or m/s] allows within
// `dt` seconds. Jumps do not pass here: they are no motion.
inline constexpr double kRateSlack = 1e-6;  // of the step; and kLimitSlack, for joints that stand
[[nodiscard]] LimiterVerdict check_rates(std::span<const double> present, std::span<const double> positions,
                                         std::span<const double> velocity, double dt) CELL_RT;

}  // namespace cellmirror::engine
