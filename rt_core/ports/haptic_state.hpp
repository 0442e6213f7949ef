// State of a haptic device and its instrument, published by the tick. Plain data of fixed size; SI, world frame.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "rt_core/base/time.hpp"
#include "rt_core/ports/haptic_device.hpp"

namespace cellmirror {

enum class HapticPhase : std::uint8_t {
  closed,    // no device belongs to this place
  waiting,   // no device has written yet, or the surroundings are not known; force zero
  clutched,  // the hand moves, the instrument does not; force zero
  engaging,  // the force is being faded in
  active,
  faulted,  // latched: force zero until it is reset (RESET_HAPTIC), or passes by itself (HapticAwaited)
};

// The first that was met counts.
enum class HapticFault : std::uint8_t {
  none,
  stale,        // no new sample for longer than stale_after, or samples whose time is older than that
  vanished,     // the device's process is gone
  not_finite,   // a value was no number, or the quaternion no rotation; of the device, or of the answer to it
  invalid,      // the device says so itself
  jump,         // faster than a hand can be
  two_writers,  // two processes write into the same block
  torn,         // the block could not be read whole for longer than stale_after
  late_tick,    // the loop missed more periods than allowed
  stale_model,  // the contact model is too old
  not_passive,  // energy was generated faster than damping could take it
};

// What a latched fault waits for before the device engages again.
enum class HapticAwaited : std::uint8_t {
  nothing,       // no fault is latched
  reset,         // RESET_HAPTIC: it does not pass by itself
  device,        // samples without a cause of a fault, for a while
  surroundings,  // a contact model that is not too old
  outside,       // the hand and the tip outside of bodies
  rest,          // the hand at rest
};

struct HapticState {
  HapticPhase phase = HapticPhase::closed;
  HapticFault fault = HapticFault::none;
  std::uint8_t slot = 0;             // of the instrument's robot
  bool awaits_surroundings = false;  // phase waiting: the device is there, a contact model is not
  std::uint64_t device_sequence = 0;
  std::uint32_t device_writer = 0;  // process id
  Timestamp device_time;
  std::uint32_t buttons = 0;
  std::uint64_t samples = 0;
  std::uint64_t skipped = 0;  // samples that were overwritten before they were read, by their numbers
  std::uint64_t torn = 0;     // reads that found the device writing
  std::uint64_t faults = 0;
  std::uint64_t resets = 0;
  std::uint64_t re_engagements = 0;  // faults that passed by themselves
  HapticAwaited awaited = HapticAwaited::nothing;
  std::uint64_t saturated = 0;  // ticks in which the force was cut to its limit or its slew limit
  Eigen::Vector3d x_device = Eigen::Vector3d::Zero();  // where the hand wants the tip, in the world
  Eigen::Vector3d x_proxy = Eigen::Vector3d::Zero();   // where the tip is: never inside of a body
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();   // N, on the hand, before scaling for the device
  Eigen::Vector3d force_E = Eigen::Vector3d::Zero();   // the same in the end-effector frame
  double axis_torque = 0;                              // Nm, about the tool axis (z of the end-effector frame)
  JointValues joint_torques{};                         // Nm or N, of the instrument's joints
  std::uint8_t contacts = 0;                           // constraints that bear force
  std::uint64_t appeared = 0;                          // bodies that appeared at the tip, so that it engaged again
  double energy = 0;                                   // J, by the passivity observer (negative: generated)
  double passivity_damping = 0;                        // Ns/m, that the passivity controller added in this tick
  Timestamp model_time;                                // posture time of the contact model in use
  // Of soft tissue, by the newest response of its worker that could be used.
  Eigen::Vector3d tissue_force_W = Eigen::Vector3d::Zero();  // N, its share of force_W
  Timestamp tissue_time;                                     // posture time of that response
  std::uint32_t tissue_contacts = 0;
  std::uint32_t tissue_held = 0;     // places that the instrument's jaws hold
  std::uint64_t tissue_late = 0;     // responses that became older than haptics::kTissueLate before another one came
  std::uint64_t tissue_refused = 0;  // responses with values that cannot be true
};

}  // namespace cellmirror
