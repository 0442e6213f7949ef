// What is watched in each step: following error, blocked motor, windows of targets.
#include "drivers/can/cia402/device/servo_drive.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::can {
namespace {

constexpr double kWatchStep = MotorModel::kStep;
constexpr std::uint16_t kErrorFollowing = 0x8611;
constexpr std::uint16_t kErrorBlocked = 0x7121;
constexpr std::uint8_t kRegisterGeneric = 0x01;
constexpr std::uint8_t kRegisterProfile = 0x20;

}  // namespace

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
  blocked_for_ += kWatchStep;
  if (blocked_for_ + kWatchStep / 2 < parameters_.blocked_time) return;
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
  beyond_for_ += kWatchStep;
  const bool reacts = power_.state() == Cia402State::fault_reaction_active;
  if (beyond_for_ <= parameters_.following_time) return;
  // The axis does not follow the stop of a fault reaction either: it is left to the brake.
  if (reacts) return power_.stands(parameters_);
  if (power_.state() != Cia402State::fault) raise_fault(kErrorFollowing, kRegisterGeneric | kRegisterProfile);
}

void ServoDrive::watch_windows() {
  const bool stands = std::abs(actual_velocity()) <= parameters_.standstill;
  standing_for_ = stands ? standing_for_ + kWatchStep : 0;
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
  reached_for_ = now ? reached_for_ + kWatchStep : 0;
  target_reached_ = now && reached_for_ > after;
}

}  // namespace cellmirror::can
