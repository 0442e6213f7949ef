// One step of the motor: what the mode, or a stop, wants of it.
#include "drivers/can/cia402/device/servo_drive.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::can {
namespace {

constexpr double kModeStep = MotorModel::kStep;

}  // namespace

bool ServoDrive::runs_mode() const { return power_.state() == Cia402State::operation_enabled && !power_.stopping(); }

bool ServoDrive::is_torque_mode() const {
  return mode_ == DriveMode::profile_torque || mode_ == DriveMode::cyclic_sync_torque;
}

bool ServoDrive::is_position_mode() const {
  return mode_ != DriveMode::profile_velocity && mode_ != DriveMode::cyclic_sync_velocity && !is_torque_mode();
}

void ServoDrive::step() {
  power_.started();
  if (!power_.is_powered()) {
    motor_.hold();
    motor_.start_control();
    demand_ = {actual(), 0, 0};
    beyond_for_ = 0;
    blocked_for_ = 0;
    stop_ramp_.reset();
    target_reached_ = false;
    return watch_windows();
  }
  if (power_.stopping()) {
    step_stop();
  } else {
    step_mode();
  }
  watch_block();
  watch_following_error();
  watch_windows();
}

void ServoDrive::step_stop() {
  if (stop_ramp_ != power_.stopping()) {
    stop_ramp_ = power_.stopping();
    const bool quick = stop_ramp_ == StopRamp::quick_stop;
    const double rate = quick ? parameters_.quick_deceleration : parameters_.profile.deceleration;
    stop_plan_.start(MotionPlan::to_velocity(demand_, 0, {1, 1, rate}));
  }
  follow(stop_plan_.step(kModeStep));
  if (stop_plan_.is_over()) power_.stands(parameters_);
}

void ServoDrive::step_mode() {
  const bool halted = (controlword_ & kControlwordHalt) != 0;
  switch (mode_) {
    case DriveMode::none:
    case DriveMode::profile_position:
      return follow(profile_position_.step(kModeStep));
    case DriveMode::homing:
      return step_homing();
    case DriveMode::profile_velocity: {
      demand_ = profile_velocity_.step(kModeStep, actual(), parameters_.lower, parameters_.upper);
      return motor_.follow_velocity(joint_of(demand_).velocity, torque_limits());
    }
    default:
      break;
  }
  if (halted && mode_ != DriveMode::profile_torque) return follow(stop_plan_.step(kModeStep));
  if (is_position_mode()) return follow(cyclic_position_.step(kModeStep));
  demand_ = {actual(), actual_velocity(), 0};
  if (mode_ == DriveMode::cyclic_sync_velocity) {
    const double room =
        velocity_demand_ > 0 ? parameters_.upper - demand_.position : demand_.position - parameters_.lower;
    // No faster than it can brake from before the limit.
    const double fastest = std::sqrt(2 * parameters_.profile.deceleration * std::max(0.0, room));
    limited_ = std::abs(velocity_demand_) > fastest;
    demand_.velocity = std::clamp(velocity_demand_, -fastest, fastest);
    return motor_.follow_velocity(joint_of(demand_).velocity, torque_limits());
  }
  step_torque();
}

void ServoDrive::step_torque() {
  if (mode_ == DriveMode::profile_torque) {
    const double most = kModeStep * parameters_.torque_slope * config_.rated_torque;
    torque_demand_ += std::clamp(torque_target_ - torque_demand_, -most, most);
  }
  // No torque towards a velocity that is too high.
  limited_ = std::abs(demand_.velocity) > parameters_.fastest;
  const bool drives_on = torque_demand_ * motor_.velocity() > 0;
  motor_.apply_torque(limited_ && drives_on ? 0.0 : torque_demand_, torque_limits());
}

void ServoDrive::step_homing() {
  const bool searched = homing_.state() == Homing::State::searching;
  follow(homing_.step(kModeStep, homing_inputs()));
  if (searched && homing_.state() == Homing::State::attained) take_home();
}

// The zero of positions is the home offset (object 0x607C) beyond home.
void ServoDrive::take_home() {
  const double raw = demand_.position + shift_;
  shift_ = homing_.home() + parameters_.home_offset;
  demand_.position = raw - shift_;
  homing_.shift(demand_.position);
}

void ServoDrive::follow(const MotionPoint& demand) {
  demand_ = demand;
  motor_.follow_position(joint_of(demand), torque_limits());
}

}  // namespace cellmirror::can
