#include "drivers/can/cia402/device/motor_model.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::can {
namespace {

constexpr double kIntegralGain = 30;  // 1/s, of the velocity loop
constexpr double kBrakeTorque = 2;    // of the holding brake, times the motor's peak torque

}  // namespace

MotorModel::MotorModel(const DriveConfig& config) : config_(config), position_(config.start) {}

void MotorModel::follow_position(const MotionPoint& demand, const TorqueLimits& limits) {
  const double error = demand.position - position_;
  control_velocity(demand.velocity + config_.position_gain * error, demand.acceleration, limits);
}

void MotorModel::follow_velocity(double velocity, const TorqueLimits& limits) { control_velocity(velocity, 0, limits); }

void MotorModel::control_velocity(double wanted, double acceleration, const TorqueLimits& limits) {
  const double error = wanted - velocity_;
  const double proportional = config_.inertia * (acceleration + config_.velocity_gain * error);
  const double torque = proportional + integral_;
  // No integration further into the limit, so that the motor does not run on when a block is gone.
  const bool within = torque > limits.lower && torque < limits.upper;
  if (within || torque * error < 0) {
    integral_ += config_.inertia * config_.velocity_gain * kIntegralGain * error * kStep;
  }
  integral_ = std::clamp(integral_, limits.lower, limits.upper);
  apply_torque(torque, limits);
}

void MotorModel::apply_torque(double torque, const TorqueLimits& limits) {
  torque_ = std::clamp(torque, limits.lower, limits.upper);
  at_limit_ = torque_ != torque;
  move(torque_, config_.coulomb_friction);
}

void MotorModel::hold() {
  torque_ = 0;
  at_limit_ = false;
  move(0, config_.coulomb_friction + kBrakeTorque * config_.peak_torque * config_.rated_torque);
}

// Implicit in the viscous friction; dry friction stops the motion and never turns it.
void MotorModel::move(double torque, double friction) {
  const double driven = velocity_ + kStep * torque / config_.inertia;
  const double dry = kStep * friction / config_.inertia;
  const double slowed = std::abs(driven) <= dry ? 0.0 : driven - std::copysign(dry, driven);
  const double free = slowed / (1 + kStep * config_.viscous_friction / config_.inertia);
  velocity_ = std::clamp(free, bounds_.lower, bounds_.upper);
  held_back_ = free > velocity_ ? 1 : free < velocity_ ? -1 : 0;
  position_ += kStep * velocity_;
  if (!config_.stops) return;
  const double inside = std::clamp(position_, config_.stops->lower, config_.stops->upper);
  if (inside == position_) return;
  held_back_ = position_ > inside ? 1 : -1;
  position_ = inside;
  velocity_ = 0;
}

}  // namespace cellmirror::can
