#include "drivers/can/cia402/device/power_state.hpp"

#include <utility>

namespace cellmirror::can {
namespace {

// Option codes (CiA 402-2, 6.4.4): 1 and 5 the slow down ramp, 2 and 6 the quick stop ramp, 0 none; 5 and 6 stay in
// "quick stop active".
std::optional<StopRamp> ramp_of(int option) {
  if (option == 1 || option == 5) return StopRamp::slow_down;
  if (option == 2 || option == 6) return StopRamp::quick_stop;
  return {};
}

bool stays_in_quick_stop(const ServoParameters& parameters) { return parameters.quick_stop_option >= 5; }

}  // namespace

bool PowerState::is_powered() const {
  return state_ == Cia402State::operation_enabled || state_ == Cia402State::quick_stop_active ||
         state_ == Cia402State::fault_reaction_active;
}

void PowerState::enter(Cia402State state) {
  state_ = state;
  stopping_.reset();
}

void PowerState::reset() {
  controlword_ = 0;
  enter(Cia402State::not_ready_to_switch_on);
}

void PowerState::started() {
  if (state_ == Cia402State::not_ready_to_switch_on) enter(Cia402State::switch_on_disabled);
}

void PowerState::command(std::uint16_t controlword, const ServoParameters& parameters) {
  const Cia402State wanted = next_state(state_, std::exchange(controlword_, controlword), controlword);
  if (wanted == state_) {
    // "Enable operation" calls a stop before "disable operation" or "shutdown" off.
    if (state_ == Cia402State::operation_enabled) stopping_.reset();
    return;
  }
  if (state_ == Cia402State::operation_enabled) {
    if (wanted == Cia402State::quick_stop_active) return quick_stop(parameters);
    if (wanted == Cia402State::switched_on) return leave_operation(wanted, parameters.disable_option);
    if (wanted == Cia402State::ready_to_switch_on) return leave_operation(wanted, parameters.shutdown_option);
  }
  // Transition 16 is there only where the drive stays in "quick stop active".
  const bool again = state_ == Cia402State::quick_stop_active && wanted == Cia402State::operation_enabled;
  if (again && !stays_in_quick_stop(parameters)) return;
  enter(wanted);
}

void PowerState::leave_operation(Cia402State wanted, int option) {
  if (const auto ramp = ramp_of(option)) {
    stopping_ = ramp;
    after_stop_ = wanted;
  } else {
    enter(wanted);
  }
}

void PowerState::quick_stop(const ServoParameters& parameters) {
  if (state_ != Cia402State::operation_enabled) return;
  const auto ramp = ramp_of(parameters.quick_stop_option);
  enter(ramp ? Cia402State::quick_stop_active : Cia402State::switch_on_disabled);
  stopping_ = ramp;
  after_stop_ = stays_in_quick_stop(parameters) ? Cia402State::quick_stop_active : Cia402State::switch_on_disabled;
}

void PowerState::disable_voltage() {
  if (state_ == Cia402State::fault || state_ == Cia402State::fault_reaction_active) return;
  if (state_ != Cia402State::not_ready_to_switch_on) enter(Cia402State::switch_on_disabled);
}

void PowerState::fault(const ServoParameters& parameters) {
  if (state_ == Cia402State::fault || state_ == Cia402State::fault_reaction_active) return;
  const auto ramp = is_powered() ? ramp_of(parameters.fault_option) : std::nullopt;
  enter(ramp ? Cia402State::fault_reaction_active : Cia402State::fault);
  stopping_ = ramp;
  after_stop_ = Cia402State::fault;
}

void PowerState::stands(const ServoParameters& parameters) {
  if (!stopping_) return;
  const bool held = state_ == Cia402State::quick_stop_active && stays_in_quick_stop(parameters);
  if (!held) enter(after_stop_);
}

}  // namespace cellmirror::can
