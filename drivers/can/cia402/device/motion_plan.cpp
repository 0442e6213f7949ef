#include "drivers/can/cia402/device/motion_plan.hpp"

#include <algorithm>
#include <cmath>

#include "rt_core/base/contract.hpp"

namespace cellmirror::can {
namespace {

MotionPoint after(const MotionPoint& start, double t) {
  return {start.position + (start.velocity + 0.5 * start.acceleration * t) * t, start.velocity + start.acceleration * t,
          start.acceleration};
}

}  // namespace

void MotionPlan::add(double duration, double acceleration) {
  if (duration <= 0) return;
  CELLMIRROR_EXPECTS(count_ < pieces_.size());
  end_.acceleration = acceleration;
  pieces_[count_++] = {duration, end_};
  end_ = after(end_, duration);
  end_.acceleration = 0;
  duration_ += duration;
}

void MotionPlan::brake(const MotionLimits& limits) {
  const double speed = std::abs(end_.velocity);
  add(speed / limits.deceleration, -std::copysign(limits.deceleration, end_.velocity));
  end_.velocity = 0;
}

MotionPlan MotionPlan::rest(double position) {
  MotionPlan plan;
  plan.end_.position = position;
  return plan;
}

MotionPlan MotionPlan::to_position(const MotionPoint& from, double target, const MotionLimits& limits) {
  MotionPlan plan;
  plan.end_ = {from.position, from.velocity, 0};
  const double stop = from.position + 0.5 * from.velocity * std::abs(from.velocity) / limits.deceleration;
  const double direction = target >= stop ? 1.0 : -1.0;
  if (from.velocity * direction < 0) plan.brake(limits);
  const double distance = std::max(0.0, direction * (target - plan.end_.position));
  const double speed = std::abs(plan.end_.velocity);
  const double a = limits.acceleration;
  const double d = limits.deceleration;
  if (speed > limits.velocity) {
    plan.add((speed - limits.velocity) / d, -direction * d);
    plan.add((distance - 0.5 * speed * speed / d) / limits.velocity, 0);
  } else {
    // The speed at which accelerating turns into braking, where the distance is too short for a plateau.
    const double turning = std::sqrt(std::max(0.0, (2 * a * d * distance + d * speed * speed) / (a + d)));
    const double fastest = std::max(speed, std::min(limits.velocity, turning));
    plan.add((fastest - speed) / a, direction * a);
    const double ramps = 0.5 * (fastest * fastest - speed * speed) / a + 0.5 * fastest * fastest / d;
    if (fastest > 0) plan.add((distance - ramps) / fastest, 0);
  }
  plan.brake(limits);
  plan.end_.position = target;
  return plan;
}

MotionPlan MotionPlan::to_velocity(const MotionPoint& from, double velocity, const MotionLimits& limits) {
  MotionPlan plan;
  plan.end_ = {from.position, from.velocity, 0};
  const double wanted = std::clamp(velocity, -limits.velocity, limits.velocity);
  if (from.velocity * wanted < 0) plan.brake(limits);
  const double change = wanted - plan.end_.velocity;
  const bool faster = std::abs(wanted) > std::abs(plan.end_.velocity);
  const double rate = faster ? limits.acceleration : limits.deceleration;
  plan.add(std::abs(change) / rate, std::copysign(rate, change));
  plan.end_.velocity = wanted;
  return plan;
}

MotionPoint MotionPlan::at(double t) const {
  for (std::size_t i = 0; i < count_; ++i) {
    if (t < pieces_[i].duration) return after(pieces_[i].start, t);
    t -= pieces_[i].duration;
  }
  return {end_.position + end_.velocity * t, end_.velocity, 0};
}

}  // namespace cellmirror::can
