#include "rt_core/engine/limiter.hpp"

#include <cmath>

namespace cellmirror::engine {

LimiterVerdict check_setpoints(std::span<const double> positions, std::span<const double> lower,
                               std::span<const double> upper) CELL_RT {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!std::isfinite(positions[i])) return LimiterVerdict::not_finite;
    if (positions[i] < lower[i] - kLimitSlack || positions[i] > upper[i] + kLimitSlack)
      return LimiterVerdict::beyond_limit;
  }
  return LimiterVerdict::passed;
}

LimiterVerdict check_rates(std::span<const double> present, std::span<const double> positions,
                           std::span<const double> velocity, double dt) CELL_RT {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double step = std::abs(positions[i] - present[i]);
    // Not <=, so that a value that is no number does not pass.
    if (!(step < velocity[i] * dt * (1 + kRateSlack) + kLimitSlack)) return LimiterVerdict::too_fast;
  }
  return LimiterVerdict::passed;
}

}  // namespace cellmirror::engine
