// What a controller writes: controlword, mode, targets.
#include "drivers/can/cia402/device/servo_drive.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cellmirror::can {
namespace {

bool rises(std::uint16_t before, std::uint16_t now, std::uint16_t bit) {
  return (now & bit) != 0 && (before & bit) == 0;
}

bool has_index(std::span<const ObjectAddress> addresses, std::uint16_t index) {
  return std::ranges::find(addresses, index, &ObjectAddress::index) != addresses.end();
}

}  // namespace

std::optional<SdoAbort> ServoDrive::check(ObjectAddress address, std::int64_t value) {
  return check_servo_object(address, value);
}

// The controlword comes last: a PDO that holds it, a mode and a target is one command.
void ServoDrive::written(std::span<const ObjectAddress> addresses, Timestamp now) {
  if (!std::ranges::all_of(addresses, is_servo_command)) parameters_ = read_servo_parameters(slave_.objects());
  if (has_index(addresses, 0x6060)) on_mode(static_cast<DriveMode>(object(0x6060)));
  if (has_index(addresses, 0x6040)) on_controlword(static_cast<std::uint16_t>(object(0x6040)));
  if (runs_mode()) {
    if (has_index(addresses, 0x607A) && mode_ == DriveMode::cyclic_sync_position) {
      take_position(static_cast<double>(object(0x607A)));
    }
    const bool interpolates = mode_ == DriveMode::interpolated_position && interpolating_;
    if (has_index(addresses, 0x60C1) && interpolates) take_position(static_cast<double>(object(0x60C1, 1)));
    take_targets();
  }
  release_acknowledgement();
  write_objects();
  slave_.changed(now);
}

void ServoDrive::on_controlword(std::uint16_t controlword) {
  const std::uint16_t before = std::exchange(controlword_, controlword);
  const Cia402State old_state = power_.state();
  const bool ran = runs_mode();
  power_.command(controlword, parameters_);
  if (old_state == Cia402State::fault && power_.state() != old_state) {
    error_code_ = 0;
    slave_.emergency(0, 0);
  }
  if (!runs_mode()) return;
  if (!ran) start_mode();
  on_mode_bits(ran ? before : std::uint16_t{0}, controlword);
}

// A mode that does not exist comes by PDO only: the one before stays, which the display tells.
void ServoDrive::on_mode(DriveMode mode) {
  if (mode == mode_ || check_servo_object({0x6060, 0}, static_cast<int>(mode))) return;
  mode_ = mode;
  set_point_acknowledged_ = false;
  if (runs_mode()) start_mode();
}

void ServoDrive::start_mode() {
  stop_ramp_.reset();
  limited_ = false;
  interpolating_ = false;
  reached_for_ = 0;
  beyond_for_ = 0;
  torque_demand_ = 0;
  torque_target_ = 0;
  velocity_demand_ = 0;
  profile_position_.enter(demand_, parameters_.profile.deceleration);
  profile_velocity_.aim(demand_, 0, parameters_.profile);
  cyclic_position_.enter(demand_);
  homing_.enter(demand_, parameters_.homing_acceleration);
  if (mode_ == DriveMode::profile_velocity || mode_ == DriveMode::profile_torque) take_targets();
}

void ServoDrive::on_mode_bits(std::uint16_t before, std::uint16_t controlword) {
  if (((before ^ controlword) & kControlwordHalt) != 0) on_halt((controlword & kControlwordHalt) != 0);
  const bool starts = rises(before, controlword, kControlwordModeStart);
  const bool ends = rises(controlword, before, kControlwordModeStart);
  switch (mode_) {
    case DriveMode::profile_position:
      if (starts) on_set_point(controlword);
      return;
    case DriveMode::homing: {
      if (ends && homing_.state() == Homing::State::searching) homing_.enter(demand_, parameters_.homing_acceleration);
      const auto method = homing_method(parameters_.homing_method);
      if (!starts || !method || (controlword & kControlwordHalt) != 0) return;
      homing_.start(*method, demand_, homing_inputs(), parameters_.homing_fast, parameters_.homing_slow,
                    parameters_.homing_acceleration);
      if (homing_.state() == Homing::State::attained) take_home();
      return;
    }
    case DriveMode::interpolated_position:
      if (starts) cyclic_position_.enter(demand_);
      interpolating_ = (controlword & kControlwordModeStart) != 0;
      return;
    default:
      return;
  }
}

void ServoDrive::on_set_point(std::uint16_t controlword) {
  const bool relative = (controlword & kControlwordRelative) != 0;
  const auto wanted = static_cast<double>(object(0x607A));
  const double target = within_limits(relative ? profile_position_.newest_target() + wanted : target_of(wanted, false));
  const bool immediately = (controlword & kControlwordImmediately) != 0;
  const bool pass = (controlword & kControlwordPass) != 0;
  if (!profile_position_.set_point(demand_, target, parameters_.profile, immediately, pass)) return;
  set_point_acknowledged_ = true;
  reached_for_ = 0;
  target_reached_ = false;
}

void ServoDrive::on_halt(bool halt) {
  const double deceleration = halt_deceleration();
  target_reached_ = false;
  reached_for_ = 0;
  switch (mode_) {
    case DriveMode::profile_position:
      if (halt) return profile_position_.halt(demand_, deceleration);
      return profile_position_.resume(demand_);
    case DriveMode::homing:
      return homing_.enter(demand_, deceleration);
    case DriveMode::profile_velocity:
      if (!halt) return take_targets();
      return profile_velocity_.aim(demand_, 0, {parameters_.fastest, parameters_.profile.acceleration, deceleration});
    case DriveMode::profile_torque:
      return take_targets();
    default:
      if (halt) return stop_plan_.start(MotionPlan::to_velocity(demand_, 0, {1, 1, deceleration}));
      return cyclic_position_.enter(demand_);
  }
}

void ServoDrive::take_targets() {
  const bool halted = (controlword_ & kControlwordHalt) != 0;
  const auto velocity = [&] {
    const auto wanted = static_cast<double>(object(0x60FF) + object(0x60B1));
    return std::clamp(wanted, -parameters_.fastest, parameters_.fastest);
  };
  switch (mode_) {
    case DriveMode::profile_velocity: {
      MotionLimits limits = parameters_.profile;
      limits.velocity = parameters_.fastest;
      if (!halted) profile_velocity_.aim(demand_, velocity() - static_cast<double>(object(0x60B1)), limits);
      return;
    }
    case DriveMode::cyclic_sync_velocity:
      velocity_demand_ = velocity();
      return;
    case DriveMode::profile_torque:
      torque_target_ = halted ? 0 : joint_sign_ * 1e-3 * config_.rated_torque * static_cast<double>(object(0x6071));
      return;
    case DriveMode::cyclic_sync_torque:
      torque_demand_ = joint_sign_ * 1e-3 * config_.rated_torque * static_cast<double>(object(0x6071) + object(0x60B2));
      return;
    default:
      return;
  }
}

// A cyclic target is always less than half a range away, so that the shorter way is right.
void ServoDrive::take_position(double target) {
  cyclic_position_.aim(within_limits(target_of(target, true)), parameters_.period);
}

double ServoDrive::target_of(double wanted, bool nearest) const {
  constexpr int kNegative = 1;
  constexpr int kPositive = 2;
  constexpr int kShortest = 3;
  // A target where the drive already stands is not a turn away, however its position was rounded.
  constexpr double kSame = 0.5;  // increments
  const double span = parameters_.range_span;
  const double at = demand_.position;
  double target = wanted + span * std::floor((at - parameters_.range_lower) / span);
  const int option = nearest ? kShortest : parameters_.rotary_option;
  if (option == kShortest) target += span * std::round((at - target) / span);
  if (option == kPositive && target < at - kSame) target += span;
  if (option == kNegative && target > at + kSame) target -= span;
  return target;
}

double ServoDrive::within_limits(double target) {
  const double inside = std::clamp(target, parameters_.lower, parameters_.upper);
  limited_ = inside != target;
  return inside;
}

}  // namespace cellmirror::can
