// The object dictionary that a Cia402Drive starts with.
#pragma once

#include "drivers/can/canopen/object_dictionary.hpp"

namespace cellmirror::can {

struct Cia402DriveConfig;

inline constexpr ObjectAddress kErrorRegister{0x1001, 0};
inline constexpr ObjectAddress kErrorCode{0x603F, 0};
inline constexpr ObjectAddress kControlword{0x6040, 0};
inline constexpr ObjectAddress kStatusword{0x6041, 0};
inline constexpr ObjectAddress kModesOfOperation{0x6060, 0};
inline constexpr ObjectAddress kModeDisplay{0x6061, 0};
inline constexpr ObjectAddress kPositionActual{0x6064, 0};
inline constexpr ObjectAddress kVelocityActual{0x606C, 0};
inline constexpr ObjectAddress kTorqueActual{0x6077, 0};
inline constexpr ObjectAddress kTargetPosition{0x607A, 0};

// CiA 301's mandatory objects, four RPDOs and TPDOs with the configured parameters, CiA 402's objects for CSP and PP.
// Breaks its contract for node numbers and mappings that are not valid.
[[nodiscard]] ObjectDictionary make_drive_objects(const Cia402DriveConfig& config);

}  // namespace cellmirror::can
