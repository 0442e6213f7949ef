// The object dictionary of a ServoDrive, and its parameters as numbers.
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/can/canopen/object_dictionary.hpp"
#include "drivers/can/canopen/sdo.hpp"
#include "drivers/can/cia402/device/motion_plan.hpp"
#include "rt_core/ports/device_config.hpp"

namespace cellmirror::can {

// CiA 301's objects, four RPDOs and TPDOs with the default mappings of CiA 402, CiA 402's objects. Positions are in
// increments of the encoder, velocities in increments/s, torques in thousandths of the rated torque.
[[nodiscard]] ObjectDictionary make_servo_objects(const DriveConfig& config, std::uint16_t heartbeat_ms);

// What a write is refused with though type and limits allow it: modes, homing methods and option codes that this drive
// does not have.
[[nodiscard]] std::optional<SdoAbort> check_servo_object(ObjectAddress address, std::int64_t value);

// Objects that set-points come with: a write of them changes no ServoParameters.
[[nodiscard]] bool is_servo_command(ObjectAddress address);

// Increments and seconds.
struct ServoParameters {
  MotionLimits profile;           // 0x6081, 0x6083, 0x6084, each within 0x607F, 0x60C5, 0x60C6
  double quick_deceleration = 1;  // 0x6085
  double fastest = 1;             // 0x607F
  double lower = 0;               // 0x607D
  double upper = 0;
  double range_lower = 0;            // 0x607B; without it, the lowest value of 32 bits
  double range_span = 1;             // increments in the range, both ends included
  int rotary_option = 0;             // 0x60F2, bits 6 and 7
  double following_window = 0;       // 0x6065; negative: not watched
  double following_time = 0;         // 0x6066
  double position_window = 0;        // 0x6067
  double position_time = 0;          // 0x6068
  double velocity_window = 0;        // 0x606D
  double velocity_time = 0;          // 0x606E
  double standstill = 0;             // 0x606F
  double standstill_time = 0;        // 0x6070
  double torque_slope = 1;           // 0x6087, share of the rated torque a second
  double torque_limit = 1;           // 0x6072, share of the rated torque
  double positive_torque_limit = 1;  // 0x60E0, the same
  double negative_torque_limit = 1;  // 0x60E1
  double blocked_time = 0;           // 0x2000; 0: not watched
  double period = 0.001;             // 0x60C2
  double home_offset = 0;            // 0x607C
  double homing_fast = 1;            // 0x6099:1
  double homing_slow = 1;            // 0x6099:2
  double homing_acceleration = 1;    // 0x609A
  int homing_method = 0;             // 0x6098
  int quick_stop_option = 2;         // 0x605A
  int shutdown_option = 0;           // 0x605B
  int disable_option = 1;            // 0x605C
  int halt_option = 1;               // 0x605D
  int fault_option = 2;              // 0x605E
  int connection_option = 1;         // 0x6007
};
[[nodiscard]] ServoParameters read_servo_parameters(const ObjectDictionary& objects);

}  // namespace cellmirror::can
