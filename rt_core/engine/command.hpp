// What the owner of the cell has the tick do: one type a kind. Values are SI and were checked by the owner; the tick
// checks them again. What is large, or has to stay while the tick uses it, is lent (Engine::lend()).
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <variant>

#include "rt_core/base/real_time.hpp"
#include "rt_core/engine/coupling.hpp"
#include "rt_core/engine/limiter.hpp"
#include "rt_core/engine/tick_state.hpp"
#include "rt_core/haptics/instrument.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/motion/move.hpp"
#include "rt_core/motion/trajectory.hpp"
#include "rt_core/ports/haptic_device.hpp"
#include "rt_core/ports/plausibility.hpp"
#include "rt_core/ports/stream_config.hpp"
#include "rt_core/rt/lease.hpp"

namespace cellmirror::engine {

struct RobotSetup {
  std::uint8_t joint_count = 0;
  JointValues positions{};  // rad or m
  JointLimits limits = {};
};

// Refused where a position is not finite or not within its limits.
struct AddRobot {
  std::uint8_t slot = 0;
  Lease<const RobotSetup> robot = {};
};

struct RemoveRobot {
  std::uint8_t slot = 0;
};

// A motion ends at once.
struct SetMode {
  std::uint8_t slot = 0;
  RobotMode mode = RobotMode::simulated;
  std::uint16_t given = 0xFFFF;  // the joints (bits) whose position the stream gives; 0: as if it gave all
  StreamAges ages = {};
  Lease<const PlausibilityBounds> plausibility = {};  // of a mirrored robot; none: everything is plausible
};

// Only while the robot is simulated, as what follows up to Couple but for SetLimits. At once; a motion ends.
struct SetPositions {
  std::uint8_t slot = 0;
  JointValues positions{};  // rad or m
};

struct SetLimits {
  std::uint8_t slot = 0;
  Lease<const JointLimits> limits = {};
};

// For the linear moves that are added from then on; of nothing: they are refused. Its variables are the robot's joints.
// The tick gives it back when another one was set and no move that runs or waits needs it.
struct SetChain {
  std::uint8_t slot = 0;
  Lease<const kinematics::Chain> chain = {};
};

struct AddMove {
  std::uint8_t slot = 0;
  Lease<const motion::Move> move = {};
};

struct StopMotion {
  std::uint8_t slot = 0;
};

struct SetPace {
  std::uint8_t slot = 0;
  double pace = 1;  // motion::MoveExecutor::set_pace()
};

struct HoldBehind {
  std::uint8_t slot = 0;
  std::uint32_t move = 0;  // motion::MoveExecutor::hold_behind()
};

// In place of a trajectory or of moves, at once: from the present posture and velocities. StopMotion brakes it; a move
// that is added takes its place. The tick gives it back when it has ended.
struct FollowTrajectory {
  std::uint8_t slot = 0;
  Lease<const motion::Trajectory> trajectory = {};
};

// The moves of the slave are braked.
struct Couple {
  Lease<const Coupling> coupling = {};
};

struct Uncouple {
  std::uint8_t slot = 0;  // of the slave
};

// A channel that is open is closed before, or gets another instrument where the device is the same: then a latched
// fault and DeviceGone stay.
struct OpenHaptic {
  std::uint8_t channel = 0;
  Lease<const haptics::Instrument> instrument = {};
  Lease<HapticDevicePort> device = {};
};

struct CloseHaptic {
  std::uint8_t channel = 0;
};

// Refused where there is no fault, or its cause is still there.
struct ResetHaptic {
  std::uint8_t channel = 0;
};

struct SetDeviceGone {
  std::uint8_t channel = 0;
  bool gone = false;  // the device's process is known to have ended
};

// In groups, since libstdc++ moves and ends what a variant holds by a branch up to eleven types, and by a table of
// pointers to functions beyond, which nothing could follow that checks what the tick calls (docs/tick.md).
using RobotCommand = std::variant<AddRobot, RemoveRobot, SetMode, SetPositions, SetLimits>;
using MotionCommand = std::variant<SetChain, AddMove, StopMotion, SetPace, HoldBehind, FollowTrajectory>;
using CouplingCommand = std::variant<Couple, Uncouple>;
using HapticCommand = std::variant<OpenHaptic, CloseHaptic, ResetHaptic, SetDeviceGone>;
using Command = std::variant<RobotCommand, MotionCommand, CouplingCommand, HapticCommand>;
static_assert(sizeof(Command) <= 152, "thousands of them wait in the queue: lend what is larger");
static_assert(std::is_nothrow_move_assignable_v<Command>);

// Calls `function` with what the variant holds, and gives what it gives. std::visit() is not for the tick: it may
// throw.
template <std::size_t I = 0, class Variant, class Function>
bool with_alternative(Variant& variant, const Function& function) CELL_RT {
  if constexpr (I < std::variant_size_v<Variant>) {
    if (auto* const held = std::get_if<I>(&variant)) return function(*held);
    return with_alternative<I + 1>(variant, function);
  } else {
    return false;  // it holds nothing: moving a command never throws
  }
}

// The same with the command itself instead of its group.
template <class AnyCommand, class Function>
bool with_command(AnyCommand& command, const Function& function) CELL_RT {
  return with_alternative(command, [&function](auto& group) CELL_RT { return with_alternative(group, function); });
}

}  // namespace cellmirror::engine
