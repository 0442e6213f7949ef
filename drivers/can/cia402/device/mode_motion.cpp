#include "drivers/can/cia402/device/mode_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cellmirror::can {

void RunningPlan::start(const MotionPlan& plan) {
  plan_ = plan;
  time_ = 0;
}

MotionPoint RunningPlan::step(double dt) {
  time_ += dt;
  return plan_.at(time_);
}

void ProfilePosition::enter(const MotionPoint& at, double deceleration) {
  waiting_.reset();
  halted_ = false;
  passing_ = 0;
  const MotionPlan stop = MotionPlan::to_velocity(at, 0, {1, 1, deceleration});
  under_way_ = {stop.at(stop.duration()).position, {1, 1, deceleration}};
  plan_.start(stop);
}

bool ProfilePosition::set_point(const MotionPoint& at, double target, const MotionLimits& limits, bool immediately,
                                bool pass) {
  if (!immediately && !plan_.is_over()) {
    if (waiting_) return false;
    waiting_ = {target, limits};
    passing_ = pass ? std::copysign(1.0, under_way_.target - at.position) : 0;
    if (pass && !halted_) start_under_way(at);
    return true;
  }
  waiting_.reset();
  passing_ = 0;
  under_way_ = {target, limits};
  if (!halted_) start_under_way(at);
  return true;
}

void ProfilePosition::start_under_way(const MotionPoint& at) {
  const MotionLimits& limits = under_way_.limits;
  plan_.start(passing_ != 0 ? MotionPlan::to_velocity(at, passing_ * limits.velocity, limits)
                            : MotionPlan::to_position(at, under_way_.target, limits));
}

void ProfilePosition::halt(const MotionPoint& at, double deceleration) {
  halted_ = true;
  plan_.start(MotionPlan::to_velocity(at, 0, {1, 1, deceleration}));
}

void ProfilePosition::resume(const MotionPoint& at) {
  halted_ = false;
  start_under_way(at);
}

void ProfilePosition::take_waiting(const MotionPoint& at) {
  under_way_ = *std::exchange(waiting_, std::nullopt);
  passing_ = 0;
  start_under_way(at);
}

MotionPoint ProfilePosition::step(double dt) {
  const MotionPoint at = plan_.step(dt);
  if (!waiting_ || halted_) return at;
  const bool there = passing_ != 0 ? passing_ * (at.position - under_way_.target) >= 0 : plan_.is_over();
  if (there) take_waiting(at);
  return at;
}

void ProfileVelocity::aim(const MotionPoint& at, double velocity, const MotionLimits& limits) {
  aimed_ = velocity;
  limits_ = limits;
  limited_ = false;
  at_ = at;
  plan_.start(MotionPlan::to_velocity(at, velocity, limits));
}

// The velocity is the plan's; the position is the axis's own, which does not always get on as planned.
MotionPoint ProfileVelocity::step(double dt, double actual, double lower, double upper) {
  at_ = {actual, plan_.step(dt).velocity, 0};
  const double stop = actual + 0.5 * at_.velocity * std::abs(at_.velocity) / limits_.deceleration;
  const bool outward = (aimed_ > 0 && stop >= upper) || (aimed_ < 0 && stop <= lower);
  if (!limited_ && outward) {
    limited_ = true;
    plan_.start(MotionPlan::to_velocity(at_, 0, limits_));
  }
  return at_;
}

void CyclicPosition::aim(double target, double period) {
  target_ = target;
  left_ = period;
  at_.velocity = (target - at_.position) / period;
}

MotionPoint CyclicPosition::step(double dt) {
  if (left_ <= dt) {
    // Where the next target is late, the axis waits at this one.
    at_.velocity = left_ > 0 ? (target_ - at_.position) / dt : 0;
    at_.position = target_;
    left_ = 0;
    return at_;
  }
  at_.position += at_.velocity * dt;
  left_ -= dt;
  return at_;
}

}  // namespace cellmirror::can
