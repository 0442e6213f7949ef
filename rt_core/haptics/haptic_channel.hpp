// One haptic device and its instrument inside the tick: reads the device, moves the instrument, answers with a force.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "rt_core/base/real_time.hpp"
#include "rt_core/haptics/contact_model.hpp"
#include "rt_core/haptics/settings.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/ports/haptic_device.hpp"
#include "rt_core/ports/haptic_state.hpp"
#include "rt_core/ports/joint_stream.hpp"

namespace cellmirror::haptics {

// What the owner of the cell prepares off the tick for a channel. It outlives the channel's use of it.
struct Instrument {
  std::uint8_t slot = 0;
  std::uint8_t joint_count = 0;  // of the robot
  kinematics::Chain chain;       // from its base to its TCP; the joints of the robot that are on the way
  std::array<std::int8_t, kMaxJointsPerRobot> variable_joint{};  // joint of the robot that a variable of the chain is
  Pose X_WB = Pose::Identity();  // its base in the world; it does not move while the channel is open
  JointValues lower{};           // rad or m, of the robot's joints
  JointValues upper{};
  HapticSettings settings;
};

struct TickInput {
  Timestamp now;
  Nanoseconds period{};
  std::uint64_t missed = 0;             // periods just before this tick
  const ContactModel* model = nullptr;  // newest; null: none yet
  std::span<const double> q;            // rad or m, where the robot stands (all joints)
  bool device_gone = false;             // the device's process is known to have ended
};

// All memory is inside; everything but the construction belongs to the tick.
class HapticChannel {
 public:
  // `instrument` and `port` outlive the time until close() has been carried out. Phase `waiting`.
  void open(const Instrument& instrument, HapticDevicePort& port) CELL_RT;
  // Writes a last output of zero force.
  void close() CELL_RT;
  // Takes a latched fault back: the force fades in anew. False where there is none, or its cause is still there.
  bool reset() CELL_RT;

  // One tick: read, judge, move, answer. True where `sample` holds new joint values of the instrument (every joint,
  // within its limits; sequence and times of the device's sample): in phases other than closed, waiting and faulted.
  bool step(const TickInput& input, JointSample& sample) CELL_RT;

  [[nodiscard]] bool used() const CELL_RT { return state_.phase != HapticPhase::closed; }
  [[nodiscard]] const HapticState& state() const CELL_RT { return state_; }

 private:
  HapticState state_;
};

}  // namespace cellmirror::haptics
