// What a cell file says about the drives that the gateway answers for: a robot of the cell behaves as CiA 402 drives on
// a CAN bus, and a real controller moves it (hardware in the loop). Plain data, SI; config/ fills it, drivers/ read it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "rt_core/base/diagnostics.hpp"

namespace cellmirror {

// An interval of joint positions [rad or m].
struct JointInterval {
  double lower = 0;
  double upper = 0;
};

// One drive = one joint. "Unit" is rad or m, of the joint; the motor's quantities are seen from the joint, behind gear
// and feed. Increments are those of the encoder: they are the drive's unit of position.
struct DriveConfig {
  std::uint8_t node_id = 0;    // 1..127
  bool waits_for_lss = false;  // has no number until a master gives it one; node_id is its serial number
  std::size_t joint = 0;       // the joint's number in the robot
  std::string joint_name;      // for messages
  // joint = sign * increments / increments_per_unit + offset
  std::uint32_t encoder_increments = 65536;  // of one revolution of the motor
  std::uint32_t gear_motor = 1;              // revolutions of the motor
  std::uint32_t gear_shaft = 1;              // ... that give so many of the shaft
  double unit_per_shaft = 1;                 // joint units of one revolution of the shaft: 2 pi rad, or the feed [m]
  double sign = 1;
  double offset = 0;
  double start = 0;                             // where the joint is when the drive is switched on
  JointInterval software_limits{-1e6, 1e6};     // object 0x607D at power-on
  std::optional<JointInterval> stops;           // mechanical ends, where the joint stands; none: it turns without end
  std::optional<JointInterval> limit_switches;  // active below the lower and above the upper
  std::optional<JointInterval> home_switch;     // active within
  double velocity = 1;                          // unit/s, object 0x607F at power-on
  double acceleration = 10;                     // unit/s2, objects 0x6083 and 0x6084 at power-on
  double inertia = 1;                           // kg m2 (kg)
  double coulomb_friction = 0;                  // Nm (N)
  double viscous_friction = 0;                  // Nm s/rad (N s/m)
  double rated_torque = 100;                    // Nm (N)
  double peak_torque = 3;                       // times the rated torque: the current limit
  double following_error = 0.05;                // unit, object 0x6065 at power-on
  double blocked_after = 0.001;                 // s, object 0x2000 at power-on; 0: not watched
  double position_gain = 40;                    // 1/s, of the position loop
  double velocity_gain = 250;                   // 1/s, of the velocity loop
  Place place = {};                             // of the node's table

  [[nodiscard]] double increments_per_unit() const {
    return static_cast<double>(encoder_increments) * gear_motor / gear_shaft / unit_per_shaft;
  }
};

}  // namespace cellmirror
