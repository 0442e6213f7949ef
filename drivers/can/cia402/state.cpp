#include "drivers/can/cia402/state.hpp"

namespace cellmirror::can {
namespace {

constexpr bool matches(std::uint16_t word, unsigned mask, unsigned value) { return (word & mask) == value; }

constexpr bool is_shutdown(std::uint16_t word) { return matches(word, 0x87, 0x06); }
constexpr bool is_switch_on(std::uint16_t word) { return matches(word, 0x8F, 0x07); }
constexpr bool is_enable_operation(std::uint16_t word) { return matches(word, 0x8F, 0x0F); }
constexpr bool is_disable_voltage(std::uint16_t word) { return matches(word, 0x82, 0x00); }
constexpr bool is_quick_stop(std::uint16_t word) { return matches(word, 0x86, 0x02); }

Cia402State from_operation_enabled(std::uint16_t word) {
  if (is_disable_voltage(word)) return Cia402State::switch_on_disabled;
  if (is_quick_stop(word)) return Cia402State::quick_stop_active;
  if (is_shutdown(word)) return Cia402State::ready_to_switch_on;
  if (is_switch_on(word)) return Cia402State::switched_on;
  return Cia402State::operation_enabled;
}

}  // namespace

Cia402State decode_statusword(std::uint16_t statusword) {
  if (matches(statusword, 0x4F, 0x00)) return Cia402State::not_ready_to_switch_on;
  if (matches(statusword, 0x4F, 0x40)) return Cia402State::switch_on_disabled;
  if (matches(statusword, 0x6F, 0x21)) return Cia402State::ready_to_switch_on;
  if (matches(statusword, 0x6F, 0x23)) return Cia402State::switched_on;
  if (matches(statusword, 0x6F, 0x27)) return Cia402State::operation_enabled;
  if (matches(statusword, 0x6F, 0x07)) return Cia402State::quick_stop_active;
  if (matches(statusword, 0x4F, 0x0F)) return Cia402State::fault_reaction_active;
  if (matches(statusword, 0x4F, 0x08)) return Cia402State::fault;
  return Cia402State::unknown;
}

std::uint16_t statusword_bits(Cia402State state) {
  switch (state) {
    case Cia402State::unknown:
    case Cia402State::not_ready_to_switch_on:
      return 0x00;
    case Cia402State::switch_on_disabled:
      return 0x40;
    case Cia402State::ready_to_switch_on:
      return 0x21;
    case Cia402State::switched_on:
      return 0x23 | kStatuswordVoltageEnabled;
    case Cia402State::operation_enabled:
      return 0x27 | kStatuswordVoltageEnabled;
    case Cia402State::quick_stop_active:
      return 0x07 | kStatuswordVoltageEnabled;
    case Cia402State::fault_reaction_active:
      return 0x0F;
    case Cia402State::fault:
      return 0x08;
  }
  return 0;
}

Cia402State next_state(Cia402State state, std::uint16_t previous, std::uint16_t controlword) {
  switch (state) {
    case Cia402State::switch_on_disabled:
      return is_shutdown(controlword) ? Cia402State::ready_to_switch_on : state;
    case Cia402State::ready_to_switch_on:
      if (is_disable_voltage(controlword) || is_quick_stop(controlword)) return Cia402State::switch_on_disabled;
      // "Enable operation" from here passes through "switched on" by itself.
      if (is_enable_operation(controlword)) return Cia402State::operation_enabled;
      return is_switch_on(controlword) ? Cia402State::switched_on : state;
    case Cia402State::switched_on:
      if (is_disable_voltage(controlword) || is_quick_stop(controlword)) return Cia402State::switch_on_disabled;
      if (is_shutdown(controlword)) return Cia402State::ready_to_switch_on;
      return is_enable_operation(controlword) ? Cia402State::operation_enabled : state;
    case Cia402State::operation_enabled:
      return from_operation_enabled(controlword);
    case Cia402State::quick_stop_active:
      if (is_disable_voltage(controlword)) return Cia402State::switch_on_disabled;
      return is_enable_operation(controlword) ? Cia402State::operation_enabled : state;
    case Cia402State::fault: {
      const bool rising = (controlword & kControlwordFaultReset) != 0 && (previous & kControlwordFaultReset) == 0;
      return rising ? Cia402State::switch_on_disabled : state;
    }
    case Cia402State::unknown:
    case Cia402State::not_ready_to_switch_on:
    case Cia402State::fault_reaction_active:
      return state;
  }
  return state;
}

std::string_view words(Cia402State state) {
  switch (state) {
    case Cia402State::unknown:
      return "unknown";
    case Cia402State::not_ready_to_switch_on:
      return "not ready to switch on";
    case Cia402State::switch_on_disabled:
      return "switch on disabled";
    case Cia402State::ready_to_switch_on:
      return "ready to switch on";
    case Cia402State::switched_on:
      return "switched on";
    case Cia402State::operation_enabled:
      return "operation enabled";
    case Cia402State::quick_stop_active:
      return "quick stop active";
    case Cia402State::fault_reaction_active:
      return "fault reaction active";
    case Cia402State::fault:
      return "fault";
  }
  return "unknown";
}

std::string_view words(DriveMode mode) {
  switch (mode) {
    case DriveMode::none:
      return "no mode";
    case DriveMode::profile_position:
      return "profile position";
    case DriveMode::profile_velocity:
      return "profile velocity";
    case DriveMode::profile_torque:
      return "profile torque";
    case DriveMode::homing:
      return "homing";
    case DriveMode::interpolated_position:
      return "interpolated position";
    case DriveMode::cyclic_sync_position:
      return "cyclic synchronous position";
    case DriveMode::cyclic_sync_velocity:
      return "cyclic synchronous velocity";
    case DriveMode::cyclic_sync_torque:
      return "cyclic synchronous torque";
  }
  return "unknown mode";
}

}  // namespace cellmirror::can
