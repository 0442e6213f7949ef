#include "sim_devices/camera/head_axis.hpp"

#include <algorithm>
#include <cmath>

#include "rt_core/base/contract.hpp"

namespace cellmirror::sim {
namespace {

constexpr double kLongestStep = 1.0;   // s
constexpr double kSmallStep = 0.0005;  // s: fine against the time of braking

}  // namespace

HeadAxis::HeadAxis(const AxisLimits& limits, double position)
    : limits_(limits), position_(std::clamp(position, limits.least, limits.most)) {
  CELLMIRROR_EXPECTS(limits.least < limits.most && limits.speed > 0 && limits.acceleration > 0);
}

double HeadAxis::within_stops(double position) const { return std::clamp(position, limits_.least, limits_.most); }

void HeadAxis::step(double goal, double speed_scale, double dt) {
  goal = within_stops(goal);
  const double largest_speed = limits_.speed * std::clamp(speed_scale, 0.0, 1.0);
  double left = std::clamp(dt, 0.0, kLongestStep);
  while (left > 0) {
    const double now = std::min(left, kSmallStep);
    small_step(goal, largest_speed, now);
    left -= now;
  }
}

// The speed from which braking at the limit just ends at the goal: v^2 = 2 a e.
void HeadAxis::small_step(double goal, double largest_speed, double dt) {
  const double error = goal - position_;
  const double change = limits_.acceleration * dt;
  if (std::abs(error) <= change * dt && std::abs(velocity_) <= 2 * change) {
    position_ = goal;
    velocity_ = 0;
    return;
  }
  // A step further on, so that it does not brake a step too late.
  const double ahead = std::max(0.0, std::abs(error) - std::abs(velocity_) * dt);
  const double wanted = std::copysign(std::min(largest_speed, std::sqrt(2 * limits_.acceleration * ahead)), error);
  velocity_ += std::clamp(wanted - velocity_, -change, change);
  position_ += velocity_ * dt;
  if (position_ != within_stops(position_)) {  // of a goal that moved too fast: it hits the stop
    position_ = within_stops(position_);
    velocity_ = 0;
  }
}

}  // namespace cellmirror::sim
