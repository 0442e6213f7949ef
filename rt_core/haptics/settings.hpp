// How a haptic device drives its instrument: the cell file's [[haptic]], defaults for what it leaves out. SI.
#pragma once

#include <cstdint>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::haptics {

enum class Drive : std::uint8_t {
  pose,    // the handle's position and orientation move the tip
  joints,  // the device's axes are the instrument's joints, in their order
};

// Guards against late samples, models and ticks, and what follows on such a fault.
enum class HapticProfile : std::uint8_t {
  desktop,  // survives a machine that is busy with other things; such a fault passes by itself
  strict,   // for a device whose force can do harm: milliseconds, and each fault stays until RESET_HAPTIC
};

struct HapticSettings {
  Drive drive = Drive::pose;
  Pose X_WD = Pose::Identity();  // the device's base in the world: its axes; the origin is the tip position
                                 // when the handle is at the device's zero (drive pose)
  double workspace_scale = 1.0;  // metres of the cell a metre of the device (drive pose)
  double force_scale = 1.0;      // newton at the device a newton of the cell
  int clutch_button = -1;        // bit that uncouples while it is on; -1: none
  int gripper_joint = -1;        // joint of the robot that the gripper drives; -1: none
  double gripper_scale = 1.0;    // rad (m) of the joint a rad of the gripper
  double gripper_offset = 0.0;   // rad (m)

  double stiffness = 1000.0;     // N/m, of the spring between hand and tip
  double damping = 1.0;          // Ns/m, of the same
  double static_friction = 0.3;  // coefficients of Coulomb's law
  double dynamic_friction = 0.2;
  double max_force = 8.0;                // N, at the device
  double max_slew = 4000.0;              // N/s, at the device; a force that goes to zero for a fault is not slowed
  double max_speed = 3.0;                // m/s of the handle (drive joints: of the tip): faster is a jump
  Nanoseconds engage_time{300'000'000};  // in which the force fades in
  HapticProfile profile = HapticProfile::desktop;  // from which the next four are, where they are not given
  Nanoseconds stale_after{100'000'000};            // of a device's sample
  Nanoseconds model_stale_after{500'000'000};      // of the contact model
  std::uint32_t allowed_missed_periods = 100;      // in a row
  bool re_engage = true;                           // after a fault of time or transport (re_engagement.hpp)
  bool passivity_control = true;
  double energy_allowance = 1e-3;         // J that may be generated before the controller takes force away
  double max_passivity_damping = 1000.0;  // Ns/m, that taking force away may amount to
};

inline void apply(HapticProfile profile, HapticSettings& settings) {
  const HapticSettings desktop;
  const bool strict = profile == HapticProfile::strict;
  settings.profile = profile;
  settings.stale_after = strict ? Nanoseconds{3'000'000} : desktop.stale_after;
  settings.model_stale_after = strict ? Nanoseconds{100'000'000} : desktop.model_stale_after;
  settings.allowed_missed_periods = strict ? 2 : desktop.allowed_missed_periods;
  settings.re_engage = !strict;
}

}  // namespace cellmirror::haptics
