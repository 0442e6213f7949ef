// Program status of virtual controllers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/time.hpp"
#include "scripts/programs/program/machine.hpp"

namespace cellmirror::program {

enum class ProgramState : std::uint8_t {
  loaded,   // never run since it was loaded
  queued,   // exec_wait: behind another program of the robot
  delayed,  // rob_program_delays, or the robot does not rest yet
  running,
  waiting,  // ProgramStatus::waits_for says for what
  held,
  ended,
  stopped,  // by command
  failed,   // ProgramStatus::error
};
[[nodiscard]] std::string_view name_of(ProgramState state);

// One program of one robot, for people and for what is published.
struct ProgramStatus {
  std::string robot;
  std::string name;  // as it was loaded
  std::string language;
  std::string file;
  ProgramState state = ProgramState::loaded;
  std::string waits_for;  // "semaphore S1", "input 3 is on"
  std::string step;       // "N40", "check point P3", "line 12": of the running move; empty before the first
  std::uint32_t line = 0;
  std::size_t statements = 0;
  bool reversible = false;
  Direction direction = Direction::forward;
  double elapsed_s = 0;              // of the present or last run; without the time in hold
  std::optional<double> expected_s;  // of the last run that came to its end undisturbed (neither held nor stepped)
  std::uint64_t runs = 0;            // begun
  std::string error;                 // of the last run: file:line:column and why
};

// Programs that wait for semaphores that no program can release any more.
struct Deadlock {
  struct Waiting {
    std::string robot;
    std::string program;
    std::string step;
    std::string semaphore;
    std::vector<std::string> releasers;    // "robot program" of those that could release it, all waiting themselves
    std::vector<std::string> not_started;  // of those that could, were they started
    std::vector<std::string> kept_by;      // "robot program was stopped": before it released what it had taken
    bool operator==(const Waiting&) const = default;
  };
  std::vector<Waiting> waiting;
  bool operator==(const Deadlock&) const = default;
  [[nodiscard]] std::string text() const;  // one line
};

// What happened, in order; the off-line simulation reports it, tests compare it. The commands of a run come in the
// order of the program whatever the timing: run twice, a program gives the same ones.
struct ProgramEvent {
  enum class Kind : std::uint8_t {
    started,
    command,     // given to the tick (moves, delays), carried out, or begun to wait for
    done,        // a command that is neither move nor delay was carried out, or what it waited for has come
    move_ended,  // also a delay
    ended,
    stopped,
    failed,
    held,
    resumed,
    deadlock,
  };
  Kind kind = Kind::started;
  Timestamp time;  // move_ended, done, ended: the instant at which it happened, not that at which it was noticed
  std::string robot;
  std::string program;
  std::string text;          // command, done: the trace line; failed, deadlock: why
  std::uint32_t ticket = 0;  // command and move_ended of moves and delays: ProgramMotion's
  std::uint32_t line = 0;    // of the program's text; 0: none
};
[[nodiscard]] std::string_view name_of(ProgramEvent::Kind kind);

}  // namespace cellmirror::program
