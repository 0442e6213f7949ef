#include "rt_core/motion/profile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cellmirror::motion {

namespace {

// Factor by which an axis may exceed its acceleration to avoid overshoot: the peak of a sine. A ramp needs it for
// rounding only.
double hardest_braking(double acceleration, VelocityProfile shape) CELL_RT {
  constexpr double kRounding = 1e-6;
  return acceleration * (shape == VelocityProfile::sine ? std::numbers::pi / 2 : 1.0) * (1 + kRounding);
}

// The way until rest; positive.
double braking_way(double velocity, double acceleration) CELL_RT { return velocity * velocity / (2 * acceleration); }

// How long stopping takes, at the acceleration or at what the room ahead allows.
double stopping_time(double position, double velocity, const AxisLimits& limits) CELL_RT {
  if (velocity == 0) return 0;
  const double room = std::max(velocity > 0 ? limits.upper - position : position - limits.lower, 0.0);
  return std::min(std::abs(velocity) / limits.acceleration, 2 * room / std::abs(velocity));
}

enum class Beginning { onward, exact_stop, turn_round };

// `way` and `velocity` in the direction of the velocity, which is positive.
Beginning beginning_of(double way, double velocity, double acceleration, VelocityProfile shape) CELL_RT {
  if (way <= 0) return Beginning::turn_round;
  if (braking_way(velocity, acceleration) < way) return Beginning::onward;
  return braking_way(velocity, hardest_braking(acceleration, shape)) <= way ? Beginning::exact_stop
                                                                            : Beginning::turn_round;
}

}  // namespace

double Ramp::way(double t) const CELL_RT {
  if (v0 == v1) return v0 * t;
  if (shape == VelocityProfile::ramp) return v0 * t + 0.5 * (v1 - v0) * t * t / duration;
  const double omega = std::numbers::pi / duration;
  return v0 * t + 0.5 * (v1 - v0) * (t - std::sin(omega * t) / omega);
}

double Ramp::velocity(double t) const CELL_RT {
  if (v0 == v1) return v0;
  const double share = t / duration;
  if (shape == VelocityProfile::ramp) return v0 + (v1 - v0) * share;
  return v0 + 0.5 * (v1 - v0) * (1 - std::cos(std::numbers::pi * share));
}

double Ramp::acceleration(double t) const CELL_RT {
  if (v0 == v1) return 0;
  const double mean = (v1 - v0) / duration;
  if (shape == VelocityProfile::ramp) return mean;
  return mean * (std::numbers::pi / 2) * std::sin(std::numbers::pi * t / duration);
}

void Profile::append(double duration, double v0, double v1, VelocityProfile shape) CELL_RT {
  if (!(duration > 0)) return;
  ramps_[count_++] = {duration, v0, v1, shape};
  duration_ += duration;
}

void Profile::append_from_rest(double way, double velocity, double acceleration, VelocityProfile shape) CELL_RT {
  const double length = std::abs(way);
  const double top = std::min(velocity, std::sqrt(acceleration * length));
  if (!(top > 0)) return;
  const double signed_top = std::copysign(top, way);
  append(top / acceleration, 0, signed_top, shape);
  append(length / top - top / acceleration, signed_top, signed_top, shape);
  append(top / acceleration, signed_top, 0, shape);
}

Profile Profile::to_rest(double position, double velocity, const AxisLimits& limits) CELL_RT {
  Profile profile;
  profile.start_ = position;
  profile.append(stopping_time(position, velocity, limits), velocity, 0, VelocityProfile::ramp);
  profile.target_ = position + (profile.count_ > 0 ? profile.ramps_[0].way() : 0.0);
  return profile;
}

Profile Profile::to_target(double position, double velocity, double target, const AxisLimits& limits,
                           VelocityProfile shape) CELL_RT {
  Profile profile;
  profile.start_ = position;
  profile.target_ = target;
  const double a = limits.acceleration;
  if (velocity == 0) {
    profile.append_from_rest(target - position, limits.velocity, a, shape);
    return profile;
  }
  const double sign = std::copysign(1.0, velocity);
  const double v0 = std::abs(velocity);
  const double way = (target - position) * sign;
  switch (beginning_of(way, v0, a, shape)) {
    case Beginning::exact_stop:
      profile.append(2 * way / v0, velocity, 0, VelocityProfile::ramp);
      break;
    case Beginning::turn_round: {
      profile.append(stopping_time(position, velocity, limits), velocity, 0, VelocityProfile::ramp);
      const double stopped = position + (profile.count_ > 0 ? profile.ramps_[0].way() : 0.0);
      profile.append_from_rest(target - stopped, limits.velocity, a, shape);
      break;
    }
    case Beginning::onward: {
      const double top = std::min(limits.velocity, std::sqrt(a * way + 0.5 * v0 * v0));
      const double change = std::abs(top - v0) / a;
      const double cruise = way - 0.5 * (v0 + top) * change - braking_way(top, a);
      profile.append(change, velocity, sign * top, VelocityProfile::ramp);
      profile.append(cruise / top, sign * top, sign * top, shape);
      profile.append(top / a, sign * top, 0, shape);
      break;
    }
  }
  return profile;
}

double Profile::velocity_for(double duration, double position, double velocity, double target, const AxisLimits& limits,
                             VelocityProfile shape) CELL_RT {
  const double a = limits.acceleration;
  double v0 = std::abs(velocity);
  double way = v0 > 0 ? (target - position) * std::copysign(1.0, velocity) : std::abs(target - position);
  if (v0 > 0) {
    const Beginning beginning = beginning_of(way, v0, a, shape);
    if (beginning == Beginning::exact_stop) return limits.velocity;
    if (beginning == Beginning::turn_round) {
      const double stopping = stopping_time(position, velocity, limits);
      way = std::abs(way - 0.5 * v0 * stopping);
      duration -= stopping;
      v0 = 0;
    }
  }
  if (!(way > 0) || !(duration > 0)) return limits.velocity;
  // Slower than now: v0 / a of changing speed altogether, and the rest of the way at the cruise.
  const double rest = duration - v0 / a;
  const double below = rest > 0 ? (way - braking_way(v0, a)) / rest : limits.velocity;
  if (below <= v0) return std::min(below, limits.velocity);
  // Faster than now: v^2 - (v0 + a duration) v + a way + v0^2 / 2 = 0, the smaller root, without cancellation.
  const double b = v0 + a * duration;
  const double c = a * way + 0.5 * v0 * v0;
  const double root = std::sqrt(std::max(b * b - 4 * c, 0.0));
  return std::min(2 * c / (b + root), limits.velocity);
}

double Profile::acceleration_for(double duration, double way, double velocity) CELL_RT {
  const double length = std::abs(way);
  if (!(length > 0)) return 0;
  const double ramp = duration - length / velocity;
  if (!(ramp > 0)) return std::numeric_limits<double>::infinity();
  // With a cruise, T = L / v + v / a; without one, T = 2 sqrt(L / a).
  return velocity * duration <= 2 * length ? velocity / ramp : 4 * length / (duration * duration);
}

Profile::State Profile::at(double t) const CELL_RT {
  State state{target_, 0, 0, true};
  if (t >= duration_) return state;
  state.position = start_;
  t = std::max(t, 0.0);
  for (std::size_t i = 0; i < count_; ++i) {
    const Ramp& ramp = ramps_[i];
    if (t < ramp.duration || i + 1 == count_) {
      const double within = std::min(t, ramp.duration);
      state.position += ramp.way(within);
      state.velocity = ramp.velocity(within);
      state.acceleration = ramp.acceleration(within);
      state.braking_to_target = i + 1 == count_ && ramp.v1 == 0;
      return state;
    }
    state.position += ramp.way();
    t -= ramp.duration;
  }
  return state;
}

}  // namespace cellmirror::motion
