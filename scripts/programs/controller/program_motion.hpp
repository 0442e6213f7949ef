// Interface of virtual controllers to the robots and the gateway. The gateway and the offline simulation implement it.
// Every call comes from the thread that owns the cell. SI. A refusal has a reason.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/robot_parameters.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "scripts/commands/activity.hpp"
#include "scripts/programs/program/canonical.hpp"

namespace cellmirror::program {

// How far a robot is with the moves of its program.
struct MotionProgress {
  enum class End : std::uint8_t { arrived, stopped, superseded, blocked };
  std::uint32_t finished = 0;  // ticket of the newest move that has ended; 0: none
  End end = End::arrived;      // how it, and all that ended with it, ended
  Timestamp finished_time;     // the tick at which it ended
  bool moving = false;         // also in a delay, and while it brakes
  double pace = 1;             // 0: held and at rest
};

class ProgramMotion {
 public:
  virtual ~ProgramMotion() = default;
  // Whether programs may move the robot now: refused while it is unknown, mirrored (ROBOT online) or follows a master.
  virtual Result<void> check(std::string_view robot) const = 0;
  // Moves are queued in the tick, so there is no gap between them. False: no room now, retry.
  [[nodiscard]] virtual bool room(std::string_view robot) const = 0;
  // Puts a move behind those before. `begin`: the instant at which it should have begun (that of the end of what it
  // waited for), when that is over already: it begins as far on as the time that has passed since, so that the time it
  // takes to notice does not add up; never: behind the one before. Returns its ticket, ascending from 1. Refused where
  // the target cannot be reached, the way leads beyond limits, ...
  virtual Result<std::uint32_t> move(std::string_view robot, const MoveCommand& command, Timestamp begin) = 0;
  virtual Result<std::uint32_t> delay(std::string_view robot, double seconds, Timestamp begin) = 0;
  virtual Result<void> set_tool(std::string_view robot, const std::optional<Pose>& X_PT) = 0;
  [[nodiscard]] virtual MotionProgress progress(std::string_view robot) const = 0;
  // 0: brakes on its path and waits there; 1: continues. Within the robot's accelerations.
  virtual Result<void> set_pace(std::string_view robot, double pace) = 0;
  // Moves with tickets beyond this one do not begin: the robot stops at its end, even of a fly move. 0: all may begin.
  // For steps.
  virtual Result<void> hold_behind(std::string_view robot, std::uint32_t ticket) = 0;
  // Brakes and discards queued moves. At pace 0 too: the running one ends where the robot is.
  virtual Result<void> stop(std::string_view robot) = 0;

  [[nodiscard]] virtual std::span<const JointKind> joint_kinds(std::string_view robot) const = 0;
  [[nodiscard]] virtual JointValues joints(std::string_view robot) const = 0;     // rad or m; present position
  [[nodiscard]] virtual Result<Pose> position(std::string_view robot) const = 0;  // X_ZT
  [[nodiscard]] virtual double program_delay(std::string_view robot) const = 0;   // s; rob_program_delays
};

// SCRIPT commands from inside programs.
class ProgramScripts {
 public:
  virtual ~ProgramScripts() = default;
  // Executes one command now; `source` names program and line in messages. The activity ends when what it began has
  // ended (a robot has arrived); null: it is done.
  virtual Result<ActivityHandle> execute(std::string_view text, std::string_view source) = 0;
};

}  // namespace cellmirror::program
