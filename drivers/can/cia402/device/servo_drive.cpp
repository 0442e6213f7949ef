#include "drivers/can/cia402/device/servo_drive.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kMotorStep = 500us;
static_assert(MotorModel::kStep == 0.0005);
constexpr double kStep = MotorModel::kStep;
constexpr Nanoseconds kMostBehind = 100ms;  // of motion that is made up for

constexpr ObjectAddress kServoStatusword{0x6041, 0};
constexpr std::uint16_t kErrorMasterLost = 0x8130;
constexpr std::uint16_t kErrorFollowing = 0x8611;
constexpr std::uint16_t kErrorBlocked = 0x7121;
constexpr std::uint8_t kRegisterGeneric = 0x01;
constexpr std::uint8_t kRegisterProfile = 0x20;
constexpr std::uint16_t kHomingAttained = kStatuswordModeBit12;
constexpr std::uint16_t kHomingError = kStatuswordModeBit13;
constexpr int kSlowDown = 1;  // option code

std::int64_t increments(double value) {
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();
  return std::llround(std::clamp(value, -kMost, kMost));
}

bool rises(std::uint16_t before, std::uint16_t now, std::uint16_t bit) {
  return (now & bit) != 0 && (before & bit) == 0;
}

bool has_index(std::span<const ObjectAddress> addresses, std::uint16_t index) {
  return std::ranges::find(addresses, index, &ObjectAddress::index) != addresses.end();
}

}  // namespace

ServoDrive::ServoDrive(const DriveConfig& config, std::uint16_t heartbeat_ms, FrameOutput& output)
    : config_(config),
      scale_(config.increments_per_unit()),
      joint_sign_(config.sign < 0 ? -1.0 : 1.0),
      slave_(config.node_id, make_servo_objects(config, heartbeat_ms), kServoStatusword, *this, output),
      motor_(config),
      parameters_(read_servo_parameters(slave_.objects())) {
  if (config.waits_for_lss) slave_.wait_for_number();
}

void ServoDrive::power_on(Timestamp now) {
  moved_ = now;
  slave_.power_on(NmtState::pre_operational, now);
}

void ServoDrive::on_reset(Timestamp /*now*/) {
  power_.reset();
  parameters_ = read_servo_parameters(slave_.objects());
  mode_ = DriveMode::none;
  controlword_ = 0;
  error_code_ = 0;
  set_point_acknowledged_ = false;
  limited_ = false;
  stop_ramp_.reset();
  demand_ = {actual(), 0, 0};
  slave_.objects().write_integer({0x607A, 0}, increments(actual()));
  write_objects();
}

// --- What the controller writes

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
  const double target = within_limits(relative ? profile_position_.newest_target() + wanted : wanted);
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

void ServoDrive::take_position(double target) { cyclic_position_.aim(within_limits(target), parameters_.period); }

double ServoDrive::within_limits(double target) {
  const double inside = std::clamp(target, parameters_.lower, parameters_.upper);
  limited_ = inside != target;
  return inside;
}

void ServoDrive::synced(Timestamp /*now*/) {}

void ServoDrive::communication_lost(Timestamp now) {
  constexpr int kFault = 1;
  constexpr int kDisableVoltage = 2;
  constexpr int kQuickStop = 3;
  if (!power_.is_powered()) return;
  if (parameters_.connection_option == kFault) {
    error_code_ = kErrorMasterLost;
    power_.fault(parameters_);
  }
  if (parameters_.connection_option == kDisableVoltage) power_.disable_voltage();
  if (parameters_.connection_option == kQuickStop) power_.quick_stop(parameters_);
  write_objects();
  slave_.changed(now);
}

// --- Motion

void ServoDrive::receive(const CanFrame& frame, Timestamp now) {
  move(now);
  slave_.receive(frame, now);
}

void ServoDrive::advance(Timestamp now) {
  move(now);
  slave_.advance(now);
}

void ServoDrive::move(Timestamp now) {
  if (!slave_.is_powered()) return;
  if (now - moved_ > kMostBehind) moved_ = now - kMostBehind;
  if (moved_ + kMotorStep > now) return;
  for (; moved_ + kMotorStep <= now; moved_ = moved_ + kMotorStep) step();
  write_objects();
  slave_.changed(now);
}

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
  follow(stop_plan_.step(kStep));
  if (stop_plan_.is_over()) power_.stands(parameters_);
}

void ServoDrive::step_mode() {
  const bool halted = (controlword_ & kControlwordHalt) != 0;
  switch (mode_) {
    case DriveMode::none:
    case DriveMode::profile_position:
      return follow(profile_position_.step(kStep));
    case DriveMode::homing:
      return step_homing();
    case DriveMode::profile_velocity: {
      demand_ = profile_velocity_.step(kStep, actual(), parameters_.lower, parameters_.upper);
      return motor_.follow_velocity(joint_of(demand_).velocity, torque_limits());
    }
    default:
      break;
  }
  if (halted && mode_ != DriveMode::profile_torque) return follow(stop_plan_.step(kStep));
  if (is_position_mode()) return follow(cyclic_position_.step(kStep));
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
    const double most = kStep * parameters_.torque_slope * config_.rated_torque;
    torque_demand_ += std::clamp(torque_target_ - torque_demand_, -most, most);
  }
  // No torque towards a velocity that is too high.
  limited_ = std::abs(demand_.velocity) > parameters_.fastest;
  const bool drives_on = torque_demand_ * motor_.velocity() > 0;
  motor_.apply_torque(limited_ && drives_on ? 0.0 : torque_demand_, torque_limits());
}

void ServoDrive::step_homing() {
  const bool searched = homing_.state() == Homing::State::searching;
  follow(homing_.step(kStep, homing_inputs()));
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

// The motor presses against an obstacle or a mechanical stop with its rated torque, or with all that its limits leave.
// A controller that commands torques may want just that.
void ServoDrive::watch_block() {
  const bool torque_mode = is_torque_mode() && !power_.stopping();
  const int held = motor_.held_back();
  const TorqueLimits limits = torque_limits();
  const double pressure = held * motor_.torque();
  const double most = held > 0 ? limits.upper : -limits.lower;
  const bool blocked = held != 0 && pressure > 0 && pressure >= std::min(config_.rated_torque, most);
  if (!blocked || torque_mode || parameters_.blocked_time <= 0) {
    blocked_for_ = 0;
    return;
  }
  blocked_for_ += kStep;
  if (blocked_for_ + kStep / 2 < parameters_.blocked_time) return;
  // It does not follow the stop of a fault reaction either: it is left to the brake.
  if (power_.state() == Cia402State::fault_reaction_active) return power_.stands(parameters_);
  raise_fault(kErrorBlocked, kRegisterGeneric | kRegisterProfile);
}

void ServoDrive::watch_following_error() {
  const bool watched = is_position_mode() || power_.stopping();
  const bool beyond = std::abs(demand_.position - actual()) > parameters_.following_window;
  if (!watched || parameters_.following_window < 0 || !beyond) {
    beyond_for_ = 0;
    return;
  }
  beyond_for_ += kStep;
  const bool reacts = power_.state() == Cia402State::fault_reaction_active;
  if (beyond_for_ <= parameters_.following_time) return;
  // The axis does not follow the stop of a fault reaction either: it is left to the brake.
  if (reacts) return power_.stands(parameters_);
  if (power_.state() != Cia402State::fault) raise_fault(kErrorFollowing, kRegisterGeneric | kRegisterProfile);
}

void ServoDrive::watch_windows() {
  const bool stands = std::abs(actual_velocity()) <= parameters_.standstill;
  standing_for_ = stands ? standing_for_ + kStep : 0;
  const bool halted = (controlword_ & kControlwordHalt) != 0;
  if (power_.stopping()) {
    note_target_reached(stands, parameters_.standstill_time);
  } else if (mode_ == DriveMode::profile_position && !halted) {
    const bool near = std::abs(actual() - profile_position_.target()) <= parameters_.position_window;
    note_target_reached(profile_position_.is_over() && near, parameters_.position_time);
  } else if (mode_ == DriveMode::profile_velocity && !halted) {
    const double error = actual_velocity() - static_cast<double>(object(0x60FF));
    note_target_reached(std::abs(error) <= parameters_.velocity_window, parameters_.velocity_time);
  } else if (mode_ == DriveMode::profile_torque) {
    note_target_reached(halted ? stands : torque_demand_ == torque_target_, 0);
  } else if (mode_ == DriveMode::homing && homing_.state() != Homing::State::idle && !halted) {
    note_target_reached(homing_.state() == Homing::State::attained && homing_.is_over() && stands, 0);
  } else {
    note_target_reached(stands, parameters_.standstill_time);
  }
  release_acknowledgement();
}

// Bit 12 goes back once the controller has taken its bit back, and there is room for another set-point.
void ServoDrive::release_acknowledgement() {
  const bool asked = (controlword_ & kControlwordNewSetPoint) != 0;
  if (!asked && profile_position_.has_room()) set_point_acknowledged_ = false;
}

void ServoDrive::note_target_reached(bool now, double after) {
  reached_for_ = now ? reached_for_ + kStep : 0;
  target_reached_ = now && reached_for_ > after;
}

bool ServoDrive::fail(std::uint16_t code, std::uint8_t error_register, Timestamp /*now*/) {
  raise_fault(code, error_register);
  write_objects();
  return true;
}

void ServoDrive::raise_fault(std::uint16_t code, std::uint8_t error_register) {
  error_code_ = code;
  power_.fault(parameters_);
  slave_.emergency(code, error_register);
}

// --- Objects

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
  write(0x6062, increments(demand_.position));
  write(0x6063, increments(position + shift_));
  write(0x6064, increments(position));
  write(0x606B, increments(demand_.velocity));
  write(0x606C, increments(actual_velocity()));
  write(0x6074, per_mille);
  write(0x6077, per_mille);
  write(0x60F4, increments(demand_.position - position));
  write(0x60FD, digital_inputs());
}

std::int64_t ServoDrive::object(std::uint16_t index, std::uint8_t subindex) const {
  return slave_.objects().integer({index, subindex}).value_or(0);
}

}  // namespace cellmirror::can
