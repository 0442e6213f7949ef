#include "rt_core/engine/limiter.hpp"

#include <cmath>

namespace cellmirror::engine {

LimiterVerdict check_setpoints(std::span<const double> positions, std::span<const double> lower,
                               std::span<const double> upper) CELL_RT {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!std::isfinite(positions[i])) return LimiterVerdict::not_finite;
    // So that nothing passes where a limit is no number.
    const bool within = positions[i] >= lower[i] - kLimitSlack && positions[i] <= upper[i] + kLimitSlack;
    if (!within) return LimiterVerdict::beyond_limit;
  }
  return LimiterVerdict::passed;
}

LimiterVerdict check_step(const JointStep& step, const RateLimits& limits, JointRate& now) CELL_RT {
  const double way = step.next - step.present;
  const auto within = [](double value, double limit, double slack) {
    // Not "greater" and "beyond", so that a value that is no number does not pass.
    return std::abs(value) < limit * (1 + kRateSlack) + slack;
  };
  if (!std::isfinite(step.next)) return LimiterVerdict::not_finite;
  if (!within(way, limits.velocity * step.dt, kLimitSlack)) return LimiterVerdict::too_fast;
  // No time has passed, and it has not moved.
  if (!(step.dt > 0)) return LimiterVerdict::passed;
  const double velocity = way / step.dt;
  const double acceleration = (velocity - step.before.velocity) / step.dt;
  const double jerk = (acceleration - step.before.acceleration) / step.dt;
  const double slack = kLimitSlack / (step.dt * step.dt);
  if (!within(acceleration, limits.acceleration, slack)) return LimiterVerdict::beyond_acceleration;
  if (!within(jerk, limits.jerk, slack / step.dt)) return LimiterVerdict::beyond_jerk;
  now = {.velocity = velocity, .acceleration = acceleration};
  return LimiterVerdict::passed;
}

}  // namespace cellmirror::engine
