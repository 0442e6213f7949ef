// The state machine of a drive (CiA 402-2, "power drive system finite state automaton"), for both roles: a mirror
// decodes statuswords, a drive answers controlwords. Pure functions.
#pragma once

#include <cstdint>
#include <string_view>

namespace cellmirror::can {

enum class Cia402State : std::uint8_t {
  unknown,  // no statusword was seen, or its bits fit no state
  not_ready_to_switch_on,
  switch_on_disabled,
  ready_to_switch_on,
  switched_on,
  operation_enabled,
  quick_stop_active,
  fault_reaction_active,
  fault,
};

// Object 0x6041.
inline constexpr std::uint16_t kStatuswordVoltageEnabled = 1U << 4;
inline constexpr std::uint16_t kStatuswordWarning = 1U << 7;
inline constexpr std::uint16_t kStatuswordRemote = 1U << 9;
inline constexpr std::uint16_t kStatuswordTargetReached = 1U << 10;
inline constexpr std::uint16_t kStatuswordInternalLimit = 1U << 11;
inline constexpr std::uint16_t kStatuswordModeBit12 = 1U << 12;  // PP: set-point taken; CSP: drive follows the target
inline constexpr std::uint16_t kStatuswordModeBit13 = 1U << 13;  // PP, CSP: following error; homing: error

// Object 0x6040.
inline constexpr std::uint16_t kControlwordShutdown = 0x0006;
inline constexpr std::uint16_t kControlwordSwitchOn = 0x0007;
inline constexpr std::uint16_t kControlwordEnableOperation = 0x000F;
inline constexpr std::uint16_t kControlwordQuickStop = 0x0002;
inline constexpr std::uint16_t kControlwordDisableVoltage = 0x0000;
inline constexpr std::uint16_t kControlwordFaultReset = 0x0080;
inline constexpr std::uint16_t kControlwordNewSetPoint = 0x0010;  // PP
inline constexpr std::uint16_t kControlwordModeStart = 0x0010;    // homing: start; IP: interpolate
inline constexpr std::uint16_t kControlwordImmediately = 0x0020;  // PP: the set-point replaces the one under way
inline constexpr std::uint16_t kControlwordRelative = 0x0040;     // PP
inline constexpr std::uint16_t kControlwordHalt = 0x0100;
inline constexpr std::uint16_t kControlwordPass = 0x0200;  // PP: no stop at the target before the next set-point

// Object 0x6060.
enum class DriveMode : std::int8_t {
  none = 0,
  profile_position = 1,
  profile_velocity = 3,
  profile_torque = 4,
  homing = 6,
  interpolated_position = 7,
  cyclic_sync_position = 8,
  cyclic_sync_velocity = 9,
  cyclic_sync_torque = 10,
};

[[nodiscard]] Cia402State decode_statusword(std::uint16_t statusword);
// The bits 0..6 that say the state, voltage enabled included.
[[nodiscard]] std::uint16_t statusword_bits(Cia402State state);

// Where a controlword takes a drive. `previous` is the controlword before it: a fault is reset by a rising edge of
// bit 7. "Not ready" and "fault reaction active" end by themselves: the drive's owner moves on from there.
[[nodiscard]] Cia402State next_state(Cia402State state, std::uint16_t previous, std::uint16_t controlword);

// "operation enabled".
[[nodiscard]] std::string_view words(Cia402State state);
// "profile position".
[[nodiscard]] std::string_view words(DriveMode mode);

}  // namespace cellmirror::can
