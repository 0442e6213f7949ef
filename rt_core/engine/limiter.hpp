// The one choke point for every set point that the tick lets through.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/base/real_time.hpp"

namespace cellmirror::engine {

enum class LimiterVerdict : std::uint8_t { passed, not_finite, beyond_limit };

// Set points of one robot [rad or m] against its limits. They pass as a whole or not at all, so that a robot is never
// sent to half of a posture. A value may exceed a limit by kLimitSlack, which is what unit conversion costs.
inline constexpr double kLimitSlack = 1e-9;
[[nodiscard]] LimiterVerdict check_setpoints(std::span<const double> positions, std::span<const double> lower,
                                             std::span<const double> upper) CELL_RT;

}  // namespace cellmirror::engine
