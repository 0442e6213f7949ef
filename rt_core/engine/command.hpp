// What the owner of the cell tells the tick. Values are SI and were checked by the owner; the tick's limiter checks
// again.
#pragma once

#include <cstdint>

#include "rt_core/engine/coupling.hpp"
#include "rt_core/engine/tick_state.hpp"
#include "rt_core/haptics/haptic_channel.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/ports/haptic_device.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::engine {

enum class CommandKind : std::uint8_t {
  add_robot,      // slot, joint_count, values = positions, lower, upper
  remove_robot,   // slot
  set_mode,       // slot, mode, ages, given; a motion ends at once
  set_positions,  // slot, values; only while the robot is simulated; at once, a motion ends
  set_limits,     // slot, lower, upper
  set_chain,      // slot, chain; only while the robot is simulated
  add_move,       // slot; only while the robot is simulated. Its move travels beside it: Engine::send_move()
  stop_motion,    // slot; only while the robot is simulated
  set_pace,       // slot, pace; only while the robot is simulated
  hold_behind,    // slot, last_move; only while the robot is simulated
  couple,         // slot = the slave, master, joint_count, coupled, values = greatest velocities; its moves are braked
  uncouple,       // slot = the slave
  open_haptic,    // channel, instrument, device; one that is open is closed before, or gets another instrument where
                  // the device is the same: then a latched fault and device_gone stay
  close_haptic,   // channel
  reset_haptic,   // channel; refused where there is no fault, or its cause is still there
  haptic_device,  // channel, device_gone: whether the device's process is known to have ended
};

struct Command {
  std::uint64_t id = 0;  // given by Engine::send(), ascending
  CommandKind kind = CommandKind::set_positions;
  std::uint8_t slot = 0;
  std::uint8_t joint_count = 0;
  std::uint8_t master = 0;  // slot
  std::uint16_t move = 0;   // of add_move: the engine's own
  RobotMode mode = RobotMode::simulated;
  StreamAges ages;
  std::uint16_t given = 0xFFFF;  // of set_mode: the joints (bits) whose position the stream gives; 0: as if it gave all
  JointValues values{};          // rad or m
  JointValues lower{};
  JointValues upper{};
  CoupledJoints coupled{};
  double pace = 1;              // of set_pace: motion::MoveExecutor::set_pace()
  std::uint32_t last_move = 0;  // of hold_behind: motion::MoveExecutor::hold_behind()
  // Of set_chain: for the linear moves that are added from then on. The sender owns it and keeps it until commands_done
  // has passed a later set_chain, set_mode to mirrored or remove_robot of this slot and, after a set_chain, every move
  // that was sent before it has ended (MotionState::finished in the same state). Its variables are the robot's joints.
  const kinematics::Chain* chain = nullptr;
  // Of haptic devices. The sender owns both and keeps them until commands_done has passed a later close_haptic or
  // open_haptic of this channel.
  std::uint8_t channel = 0;
  bool device_gone = false;
  const haptics::Instrument* instrument = nullptr;
  HapticDevicePort* device = nullptr;
};

}  // namespace cellmirror::engine
