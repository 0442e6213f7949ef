// The virtual controllers of all robots of the cell: programs are loaded, run, queued, held, stepped, stopped and
// deleted (manual 1.2.1, TF_LOAD, TF_RUN, TF_DELETE; docs/robot-programs.md for what is ours). One thread: the owner of
// the cell, which calls follow() often.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "scripts/programs/controller/program_motion.hpp"
#include "scripts/programs/controller/signals.hpp"
#include "scripts/programs/program/machine.hpp"
#include "scripts/programs/program/program.hpp"

namespace cellmirror::program {

class VirtualController;

enum class ProgramState : std::uint8_t {
  loaded,   // never run since it was loaded
  queued,   // exec_wait: behind another program of the robot
  delayed,  // rob_program_delays
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
  std::string step;       // "N40", "check point P3", "line 12"; empty before the first
  std::uint32_t line = 0;
  std::size_t statements = 0;
  bool reversible = false;
  Direction direction = Direction::forward;
  double elapsed_s = 0;              // of the run that goes on, or of the last one
  std::optional<double> expected_s;  // of the last run that came to its end
  std::uint64_t runs = 0;
  std::string error;  // of the last run: file:line:column and why
};

// Programs that wait for semaphores that nobody can release any more.
struct Deadlock {
  struct Waiting {
    std::string robot;
    std::string program;
    std::string step;
    std::string semaphore;
    std::vector<std::string> releasers;  // "robot program" of those that could release it, all waiting themselves
  };
  std::vector<Waiting> waiting;
  [[nodiscard]] std::string text() const;
};

// What happened, in order; the off-line simulation reports it, tests compare it.
struct ProgramEvent {
  enum class Kind : std::uint8_t { started, command, move_ended, ended, stopped, failed, held, resumed, deadlock };
  Kind kind = Kind::started;
  Timestamp time;
  std::string robot;
  std::string program;
  std::string text;  // command: its trace line; failed, deadlock: why
};

class Controllers {
 public:
  static constexpr std::size_t kMostPrograms = 64;   // loaded, of each robot
  static constexpr std::size_t kMostQueued = 64;     // waiting to run, of each robot
  static constexpr std::size_t kStatements = 2'000;  // of each program in one follow(): endless loops starve nobody
  static constexpr std::size_t kRunAhead = 8;        // moves that are given to the tick before they are due

  Controllers(ProgramMotion& motion, ProgramScripts& scripts, const Clock& clock);
  ~Controllers();
  Controllers(const Controllers&) = delete;
  Controllers& operator=(const Controllers&) = delete;

  // TF_LOAD. Replaces one of that name unless it runs or is queued (refused). Diagnostics of a program that does not
  // fit the robot are in the error's text.
  Result<void> load(std::string_view robot, std::string_view name, std::shared_ptr<const Program> program);
  enum class Begin : std::uint8_t { now, exec_wait };
  // TF_RUN. Refused: not loaded; it runs or is queued already; another one of the robot runs (without exec_wait);
  // robots that may not be moved. Backward: reversible programs only, from the last check point to the first.
  Result<void> run(std::string_view robot, std::string_view name, Begin begin,
                   Direction direction = Direction::forward);
  Result<void> remove(std::string_view robot, std::string_view name);  // TF_DELETE. Refused while it runs or is queued
  // Of the program that runs. hold() brakes on the path; resume() goes on with what is left, also after a PAUSE.
  Result<void> hold(std::string_view robot);
  Result<void> resume(std::string_view robot);
  // Held programs: one move (or what stands between two moves) in this direction; held again behind it.
  Result<void> step(std::string_view robot, Direction direction);
  // Ends the program that runs and forgets those that are queued; the robot brakes.
  Result<void> stop(std::string_view robot);
  void stop_all();
  // The robot is gone, or was put online: its programs end with that reason; `forget`: and are deleted.
  void give_up(std::string_view robot, const Error& why, bool forget);

  Result<void> set_digital_input(std::string_view robot, std::size_t number, bool on);
  Result<void> set_analogue_input(std::string_view robot, std::size_t number, double value);
  [[nodiscard]] const SignalBoard* signals(std::string_view robot) const;
  [[nodiscard]] const Semaphores& semaphores() const { return semaphores_; }

  // Goes on with everything that can go on. True where anything did.
  bool follow();
  // A program runs, waits, is held, queued or delayed.
  [[nodiscard]] bool busy() const;
  // The robot's moves belong to a program now; POS_ROB from elsewhere is refused.
  [[nodiscard]] bool moves(std::string_view robot) const;
  [[nodiscard]] std::vector<ProgramStatus> status() const;
  [[nodiscard]] const std::optional<Deadlock>& deadlock() const { return deadlock_; }
  // Counts programs that failed and deadlocks, so that WAIT can tell what failed since it began.
  [[nodiscard]] std::uint64_t failures() const { return failures_; }
  [[nodiscard]] const std::string& last_failure() const { return last_failure_; }
  void on_event(std::function<void(const ProgramEvent&)> callback) { event_ = std::move(callback); }

 private:
  ProgramMotion& motion_;
  ProgramScripts& scripts_;
  const Clock& clock_;
  std::map<std::string, std::unique_ptr<VirtualController>, std::less<>> robots_;
  Semaphores semaphores_;
  std::optional<Deadlock> deadlock_;
  std::uint64_t failures_ = 0;
  std::string last_failure_;
  std::function<void(const ProgramEvent&)> event_;
};

}  // namespace cellmirror::program
