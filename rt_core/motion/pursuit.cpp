#include "rt_core/motion/pursuit.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::motion {

namespace {

// The velocity of a step after which a joint can stop `way` from where the step begins, if each further step is slower
// by at most c, the acceleration times dt. From the velocity k c + r, with r below c, it takes k further steps of
// k c + r - c ... r, and all of them lead dt (c k (k + 1) / 2 + (k + 1) r) away. This is solved for k, then for r.
double to_stop_after(double way, double acceleration, double dt) CELL_RT {
  const double at_once = way / dt;
  if (!std::isfinite(acceleration)) return at_once;
  const double c = acceleration * dt;
  const double k = std::floor((std::sqrt(1 + 8 * at_once / c) - 1) / 2);
  return k * c + (at_once - c * k * (k + 1) / 2) / (k + 1);
}

double advance(const PursuitStep& step, const PursuitLimits& limits, double wanted) CELL_RT {
  const double slowest = -to_stop_after(std::max(step.present - limits.lower, 0.0), limits.acceleration, step.dt);
  const double fastest = to_stop_after(std::max(limits.upper - step.present, 0.0), limits.acceleration, step.dt);
  double velocity = std::clamp(wanted, -limits.velocity, limits.velocity);
  if (std::isfinite(limits.acceleration)) {
    const double change = limits.acceleration * step.dt;
    velocity = std::clamp(velocity, step.velocity - change, step.velocity + change);
  }
  velocity = std::clamp(velocity, slowest, fastest);
  return std::clamp(step.present + velocity * step.dt, limits.lower, limits.upper);
}

}  // namespace

double pursue(const PursuitStep& step, const PursuitLimits& limits) CELL_RT {
  if (!(step.dt > 0)) return step.present;
  const double target = std::clamp(step.target, limits.lower, limits.upper);
  const double target_velocity = target == step.target ? step.target_velocity : 0;
  const double way = target - step.present - target_velocity * step.dt;
  const double approach = std::copysign(to_stop_after(std::abs(way), limits.acceleration, step.dt), way);
  const double next = advance(step, limits, target_velocity + approach);
  // A remainder from rounding would be published as a velocity.
  return std::abs(next - target) <= 1e-12 * std::max(1.0, std::abs(target)) ? target : next;
}

double brake(const PursuitStep& step, const PursuitLimits& limits) CELL_RT {
  return step.dt > 0 ? advance(step, limits, 0) : step.present;
}

}  // namespace cellmirror::motion
