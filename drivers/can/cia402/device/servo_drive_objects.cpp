// What a drive shows: its objects, the statusword, and positions in increments.
#include "drivers/can/cia402/device/servo_drive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cellmirror::can {
namespace {

constexpr std::uint16_t kHomingAttained = kStatuswordModeBit12;
constexpr std::uint16_t kHomingError = kStatuswordModeBit13;
constexpr int kSlowDown = 1;  // option code

// Wraps `value` into the range of `span` increments that starts at `lower`.
std::int64_t wrapped(double value, double lower, double span) {
  constexpr double kMost = 9e15;  // a double represents whole numbers exactly up to here
  const auto whole = static_cast<std::int64_t>(std::llround(std::clamp(value, -kMost, kMost) - lower));
  const auto length = static_cast<std::int64_t>(span);
  const std::int64_t rest = whole % length;
  return static_cast<std::int64_t>(lower) + (rest < 0 ? rest + length : rest);
}

std::int64_t increments(double value) {
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();
  return std::llround(std::clamp(value, -kMost, kMost));
}

}  // namespace

double ServoDrive::raw_of_joint(double joint) const { return joint_sign_ * (joint - config_.offset) * scale_; }

MotionPoint ServoDrive::joint_of(const MotionPoint& demand) const {
  const double to_joint = joint_sign_ / scale_;
  return {(demand.position + shift_) * to_joint + config_.offset, demand.velocity * to_joint,
          demand.acceleration * to_joint};
}

HomingInputs ServoDrive::homing_inputs() const {
  HomingInputs inputs;
  const auto interval = [this](const std::optional<JointInterval>& joint) -> std::optional<JointInterval> {
    if (!joint) return {};
    const double a = raw_of_joint(joint->lower);
    const double b = raw_of_joint(joint->upper);
    return JointInterval{std::min(a, b), std::max(a, b)};
  };
  inputs.position = actual() + shift_;
  inputs.limit_switches = interval(config_.limit_switches);
  inputs.home_switch = interval(config_.home_switch);
  inputs.index_distance = config_.encoder_increments;
  return inputs;
}

// Objects 0x60E0 and 0x60E1 are in the drive's direction.
TorqueLimits ServoDrive::torque_limits() const {
  const double most = std::min(parameters_.torque_limit, config_.peak_torque);
  const double positive = config_.rated_torque * std::min(parameters_.positive_torque_limit, most);
  const double negative = config_.rated_torque * std::min(parameters_.negative_torque_limit, most);
  return joint_sign_ > 0 ? TorqueLimits{-negative, positive} : TorqueLimits{-positive, negative};
}

double ServoDrive::halt_deceleration() const {
  return parameters_.halt_option == kSlowDown ? parameters_.profile.deceleration : parameters_.quick_deceleration;
}

std::uint32_t ServoDrive::digital_inputs() const {
  const HomingInputs inputs = homing_inputs();
  return (is_active(HomingSwitch::negative_limit, inputs) ? 1U : 0U) |
         (is_active(HomingSwitch::positive_limit, inputs) ? 2U : 0U) |
         (is_active(HomingSwitch::home, inputs) ? 4U : 0U);
}

std::uint16_t ServoDrive::statusword() const {
  const Cia402State state = power_.state();
  unsigned word = statusword_bits(state) | kStatuswordRemote;
  if (state != Cia402State::not_ready_to_switch_on) word |= kStatuswordVoltageEnabled;
  if (limited_ || motor_.at_torque_limit() || profile_velocity_.is_limited()) word |= kStatuswordInternalLimit;
  if (target_reached_) word |= kStatuswordTargetReached;
  const bool beyond = power_.is_powered() && beyond_for_ > 0;
  const bool runs = runs_mode();
  switch (mode_) {
    case DriveMode::profile_position:
      if (set_point_acknowledged_) word |= kStatuswordModeBit12;
      if (beyond) word |= kStatuswordModeBit13;
      break;
    case DriveMode::profile_velocity:
      if (standing_for_ > parameters_.standstill_time) word |= kStatuswordModeBit12;
      break;
    case DriveMode::homing:
      if (homing_.state() == Homing::State::attained) word |= kHomingAttained;
      if (homing_.state() == Homing::State::failed) word |= kHomingError;
      break;
    case DriveMode::interpolated_position:
      if (runs && interpolating_) word |= kStatuswordModeBit12;
      break;
    case DriveMode::cyclic_sync_position:
      if (runs) word |= kStatuswordModeBit12;
      if (beyond) word |= kStatuswordModeBit13;
      break;
    case DriveMode::cyclic_sync_velocity:
    case DriveMode::cyclic_sync_torque:
      if (runs) word |= kStatuswordModeBit12;
      break;
    case DriveMode::profile_torque:
    case DriveMode::none:
      break;
  }
  return static_cast<std::uint16_t>(word);
}

void ServoDrive::write_objects() {
  ObjectDictionary& objects = slave_.objects();
  const auto write = [&](std::uint16_t index, std::int64_t value) { objects.write_integer({index, 0}, value); };
  const double torque = 1000 * joint_sign_ * motor_.torque() / config_.rated_torque;
  constexpr double kMostTorque = std::numeric_limits<std::int16_t>::max();
  const std::int64_t per_mille = std::llround(std::clamp(torque, -kMostTorque, kMostTorque));
  const double position = actual();
  write(0x603F, error_code_);
  write(0x6041, statusword());
  write(0x6061, static_cast<int>(mode_));
  constexpr double kLowest = std::numeric_limits<std::int32_t>::min();
  constexpr double kAll = 4'294'967'296.0;  // values of 32 bits
  write(0x6062, wrapped(demand_.position, parameters_.range_lower, parameters_.range_span));
  write(0x6063, wrapped(position + shift_, kLowest, kAll));
  write(0x6064, wrapped(position, parameters_.range_lower, parameters_.range_span));
  write(0x606B, increments(demand_.velocity));
  write(0x606C, increments(actual_velocity()));
  write(0x6074, per_mille);
  write(0x6077, per_mille);
  write(0x6078, per_mille);  // current is proportional to torque
  write(0x60F4, increments(demand_.position - position));
  write(0x60FD, digital_inputs());
}

std::int64_t ServoDrive::object(std::uint16_t index, std::uint8_t subindex) const {
  return slave_.objects().integer({index, subindex}).value_or(0);
}

}  // namespace cellmirror::can
