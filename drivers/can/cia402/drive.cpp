#include "drivers/can/cia402/drive.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "drivers/can/canopen/earlier_due.hpp"
#include "drivers/can/cia402/drive_objects.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kMotionStep = 1ms;  // profile position: how finely the drive moves between its owner's calls

}  // namespace

Cia402Drive::Cia402Drive(const Cia402DriveConfig& config, Cia402DriveOutput& output)
    : config_(config), slave_(config.node_id, make_drive_objects(config), kStatusword, *this, output) {}

void Cia402Drive::power_on(Timestamp now) {
  kept_position_ = position();
  slave_.power_on(config_.self_starting ? NmtState::operational : NmtState::pre_operational, now);
}

void Cia402Drive::power_off() { slave_.power_off(); }

void Cia402Drive::receive(const CanFrame& frame, Timestamp now) {
  kept_position_ = position();
  slave_.receive(frame, now);
}

void Cia402Drive::on_reset(Timestamp now) {
  slave_.objects().write_integer(kPositionActual, kept_position_);  // an absolute encoder does not forget
  slave_.objects().write_integer(kTargetPosition, kept_position_);
  controlword_ = 0;
  set_point_taken_ = false;
  target_reached_ = true;
  moved_ = now;
  state_ = config_.self_starting ? Cia402State::operation_enabled : Cia402State::switch_on_disabled;
  update_statusword();
}

std::optional<SdoAbort> Cia402Drive::check(ObjectAddress /*address*/, std::int64_t /*value*/) { return {}; }

bool Cia402Drive::communication_lost(Timestamp /*now*/) { return false; }

bool Cia402Drive::is_stored(ObjectAddress address) const {
  return address != kControlword && address != kModesOfOperation && address != kTargetPosition;
}

void Cia402Drive::synced(Timestamp now) { follow(now); }

// The controlword comes last: a PDO that holds it and a target is one command.
void Cia402Drive::written(std::span<const ObjectAddress> addresses, Timestamp now) {
  if (std::ranges::find(addresses, kModesOfOperation) != addresses.end()) on_mode();
  if (std::ranges::find(addresses, kControlword) != addresses.end()) {
    on_controlword(static_cast<std::uint16_t>(object(kControlword.index)), now);
  }
  follow(now);
}

void Cia402Drive::on_mode() {
  const auto wanted = static_cast<DriveMode>(object(kModesOfOperation.index));
  const bool known = wanted == DriveMode::profile_position || wanted == DriveMode::cyclic_sync_position ||
                     wanted == DriveMode::none || wanted == DriveMode::homing;
  if (known) slave_.objects().write_integer(kModeDisplay, static_cast<std::int64_t>(wanted));
  profile_position_ = position();
  profile_target_ = position();
  update_statusword();
}

void Cia402Drive::on_controlword(std::uint16_t controlword, Timestamp now) {
  const Cia402State before = state_;
  state_ = next_state(state_, controlword_, controlword);
  if (before == Cia402State::fault && state_ != before) clear_fault(now);
  if (before != Cia402State::operation_enabled && state_ == Cia402State::operation_enabled) {
    profile_position_ = position();
    profile_target_ = position();
    moved_ = now;
  }
  if (mode() == DriveMode::profile_position) on_new_set_point(controlword);
  controlword_ = controlword;
  update_statusword();
  slave_.changed(now);
}

void Cia402Drive::on_new_set_point(std::uint16_t controlword) {
  const bool wanted = (controlword & kControlwordNewSetPoint) != 0;
  if (!wanted) {
    set_point_taken_ = false;
  } else if (!set_point_taken_ && state_ == Cia402State::operation_enabled) {
    set_point_taken_ = true;
    target_reached_ = false;
    profile_position_ = position();
    const bool relative = (controlword & kControlwordRelative) != 0;
    profile_target_ = relative ? std::int64_t{position()} + target_position() : target_position();
    profile_target_ = std::clamp<std::int64_t>(profile_target_, std::numeric_limits<std::int32_t>::min(),
                                               std::numeric_limits<std::int32_t>::max());
  }
}

void Cia402Drive::follow(Timestamp now) {
  const double dt = std::max(0.0, seconds(now - moved_));
  moved_ = now;
  if (!config_.follows_targets || state_ != Cia402State::operation_enabled) return;
  const std::int32_t from = position();
  if (mode() == DriveMode::cyclic_sync_position) {
    slave_.objects().write_integer(kPositionActual, target_position());
  } else if (mode() == DriveMode::profile_position && !target_reached_) {
    const double step = dt * static_cast<double>(object(0x6081));
    const double left = static_cast<double>(profile_target_) - profile_position_;
    target_reached_ = std::abs(left) <= step;
    profile_position_ =
        target_reached_ ? static_cast<double>(profile_target_) : profile_position_ + std::copysign(step, left);
    slave_.objects().write_integer(kPositionActual, std::llround(profile_position_));
  }
  const double velocity = dt > 0 ? (static_cast<double>(position()) - from) / dt : 0.0;
  const double limit = std::numeric_limits<std::int32_t>::max();
  slave_.objects().write_integer(kVelocityActual, std::llround(std::clamp(velocity, -limit, limit)));
  update_statusword();
  if (position() != from) slave_.changed(now);
}

void Cia402Drive::advance(Timestamp now) {
  if (!is_powered()) return;
  if (mode() == DriveMode::profile_position && now - moved_ >= kMotionStep) follow(now);
  slave_.advance(now);
}

Timestamp Cia402Drive::next_due() const {
  const bool moving = is_powered() && config_.follows_targets && mode() == DriveMode::profile_position &&
                      !target_reached_ && state_ == Cia402State::operation_enabled;
  const Timestamp due = slave_.next_due();
  return moving ? earlier_due(due, moved_ + kMotionStep) : due;
}

void Cia402Drive::set_actual(std::int32_t position, std::int32_t velocity, std::int16_t torque, Timestamp now) {
  slave_.objects().write_integer(kPositionActual, position);
  slave_.objects().write_integer(kVelocityActual, velocity);
  slave_.objects().write_integer(kTorqueActual, torque);
  slave_.changed(now);
}

bool Cia402Drive::set_object(ObjectAddress address, std::int64_t value) {
  return slave_.objects().write_integer(address, value);
}

void Cia402Drive::raise_fault(std::uint16_t code, std::uint8_t error_register, Timestamp now) {
  slave_.objects().write_integer(kErrorCode, code);
  state_ = Cia402State::fault;
  update_statusword();
  slave_.emergency(code, error_register);
  slave_.changed(now);
}

void Cia402Drive::clear_fault(Timestamp now) {
  slave_.objects().write_integer(kErrorCode, 0);
  state_ = Cia402State::switch_on_disabled;
  update_statusword();
  slave_.emergency(0, 0);
  slave_.changed(now);
}

void Cia402Drive::set_state(Cia402State state, Timestamp now) {
  state_ = state;
  update_statusword();
  slave_.changed(now);
}

void Cia402Drive::update_statusword() {
  unsigned word = statusword_bits(state_) | kStatuswordRemote;
  if (target_reached_) word |= kStatuswordTargetReached;
  const bool following = mode() == DriveMode::cyclic_sync_position && state_ == Cia402State::operation_enabled;
  if (following || (mode() == DriveMode::profile_position && set_point_taken_)) word |= kStatuswordModeBit12;
  slave_.objects().write_integer(kStatusword, word);
}

DriveMode Cia402Drive::mode() const { return static_cast<DriveMode>(object(0x6061)); }
std::int32_t Cia402Drive::target_position() const { return static_cast<std::int32_t>(object(0x607A)); }
std::int32_t Cia402Drive::position() const { return static_cast<std::int32_t>(object(0x6064)); }
std::uint16_t Cia402Drive::statusword() const { return static_cast<std::uint16_t>(object(0x6041)); }

std::int64_t Cia402Drive::object(std::uint16_t index) const {
  const auto value = slave_.objects().integer({index, 0});
  return value ? *value : 0;
}

}  // namespace cellmirror::can
