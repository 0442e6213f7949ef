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
  const MotionPlan stop = MotionPlan::to_velocity(at, 0, {1, 1, deceleration});
  under_way_ = {stop.at(stop.duration()).position, {1, 1, deceleration}};
  plan_.start(stop);
}

bool ProfilePosition::set_point(const MotionPoint& at, double target, const MotionLimits& limits, bool immediately) {
  if (!immediately && !plan_.is_over()) {
    if (waiting_) return false;
    waiting_ = {target, limits};
    return true;
  }
  waiting_.reset();
  under_way_ = {target, limits};
  if (!halted_) plan_.start(MotionPlan::to_position(at, target, limits));
  return true;
}

void ProfilePosition::halt(const MotionPoint& at, double deceleration) {
  halted_ = true;
  plan_.start(MotionPlan::to_velocity(at, 0, {1, 1, deceleration}));
}

void ProfilePosition::resume(const MotionPoint& at) {
  halted_ = false;
  plan_.start(MotionPlan::to_position(at, under_way_.target, under_way_.limits));
}

MotionPoint ProfilePosition::step(double dt) {
  const MotionPoint at = plan_.step(dt);
  if (plan_.is_over() && waiting_ && !halted_) {
    under_way_ = *std::exchange(waiting_, std::nullopt);
    plan_.start(MotionPlan::to_position(at, under_way_.target, under_way_.limits));
  }
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
