#include "rt_core/dynamics/motion_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "rt_core/base/contract.hpp"

namespace cellmirror::dynamics {

double FilteredDerivative::update(double input, double dt, double time_constant) CELL_RT {
  constexpr double kRest = 1e-12;  // there, so that nothing fades out through numbers that processors are slow with
  if (std::abs(input - value_) < kRest) {
    reset(input);
    return rate_;
  }
  const double step = (1.0 - std::exp(-dt / time_constant)) * (input - value_);
  value_ += step;
  rate_ = step / dt;
  return rate_;
}

void MotionEstimate::begin(Timestamp time, std::span<const double> position, std::span<const double> velocity) CELL_RT {
  time_ = time;
  joints_ = position.size();
  for (std::size_t i = 0; i < joints_; ++i) {
    position_[i] = position[i];
    velocity_[i] = velocities_given_ ? velocity[i] : 0.0;
    acceleration_[i] = 0;
    of_position_[i].reset(position[i]);
    of_velocity_[i].reset(velocity_[i]);
  }
}

void MotionEstimate::stand_still() CELL_RT {
  time_ = Timestamp();
  joints_ = 0;
  velocities_given_ = false;
  velocity_.fill(0);
  acceleration_.fill(0);
}

void MotionEstimate::take(Timestamp time, std::span<const double> position, std::span<const double> velocity,
                          bool differences) CELL_RT {
  CELLMIRROR_EXPECTS(position.size() <= kMaxJointsPerRobot && velocity.size() == position.size());
  const bool given = std::ranges::any_of(velocity, [](double v) { return v != 0.0; });
  const bool first_given = given && !velocities_given_ && differences;
  velocities_given_ = velocities_given_ || given || !differences;
  if (time_.known() && time == time_ && position.size() == joints_) return;
  const double dt = time_.known() ? seconds(time - time_) : 0.0;
  if (dt <= 0.0 || dt > kLongestGap || position.size() != joints_ || first_given)
    return begin(time, position, velocity);
  for (std::size_t i = 0; i < joints_; ++i) {
    if (std::abs(position[i] - position_[i]) > kJump) return begin(time, position, velocity);
  }
  const double time_constant = std::max(kTimeConstant, 2.0 * dt);
  for (std::size_t i = 0; i < joints_; ++i) {
    position_[i] = position[i];
    velocity_[i] = velocities_given_ ? velocity[i] : of_position_[i].update(position[i], dt, time_constant);
    acceleration_[i] = of_velocity_[i].update(velocity_[i], dt, time_constant);
  }
  time_ = time;
}

}  // namespace cellmirror::dynamics
