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

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "scripts/programs/controller/program_motion.hpp"
#include "scripts/programs/controller/program_status.hpp"
#include "scripts/programs/controller/run_context.hpp"
#include "scripts/programs/controller/signals.hpp"
#include "scripts/programs/program/machine.hpp"
#include "scripts/programs/program/program.hpp"

namespace cellmirror::program {

class VirtualController;
struct LoadedProgram;

class Controllers {
 public:
  // A program that waits for a semaphore that no started program releases is in a deadlock only after this time: the
  // next command may start a program that releases it.
  static constexpr Nanoseconds kGrace{1'000'000'000};

  // All outlive it.
  Controllers(ProgramMotion& motion, ProgramScripts& scripts, const Clock& clock);
  ~Controllers();
  Controllers(const Controllers&) = delete;
  Controllers& operator=(const Controllers&) = delete;

  // TF_LOAD. Replaces one of that name unless it runs or is queued (refused); semaphores that no program that runs uses
  // have their first counts again then. What does not fit the robot is in the error's text.
  Result<void> load(std::string_view robot, std::string_view name, std::shared_ptr<const Program> program);
  enum class Begin : std::uint8_t { now, exec_wait };
  // TF_RUN. Refused: not loaded; it runs or is queued already; another one of the robot runs (without exec_wait);
  // robots that may not be moved. Backward: reversible programs only, from the last check point to the first.
  // It begins when the robot rests and rob_program_delays have passed.
  Result<void> run(std::string_view robot, std::string_view name, Begin begin,
                   Direction direction = Direction::forward);
  Result<void> remove(std::string_view robot, std::string_view name);  // TF_DELETE. Refused while it runs or is queued
  // Of the running program. hold() brakes on the path; resume() continues in the direction in which the program was
  // started, also after a PAUSE. Waits do not time out while it is held.
  Result<void> hold(std::string_view robot);
  Result<void> resume(std::string_view robot);
  // Held programs: to the end of the next move in this direction, and held again there. Statements before that move
  // execute (forward). Backward: reversible programs only.
  Result<void> step(std::string_view robot, Direction direction);
  // Ends the program that runs and forgets those that are queued; the robot brakes. Refused where none does.
  Result<void> stop(std::string_view robot);
  void stop_all();
  // The robot is gone, or was put online: its programs end with that reason, as failed; `forget`: and are deleted.
  void cancel(std::string_view robot, const Error& why, bool forget);

  // Refused: unknown robots, numbers beyond 1 .. kMostPorts, values that are not finite.
  Result<void> set_digital_input(std::string_view robot, std::size_t number, bool on);
  Result<void> set_analogue_input(std::string_view robot, std::size_t number, double value);
  // Null: nothing was loaded for it or set yet.
  [[nodiscard]] const SignalBoard* signals(std::string_view robot) const;
  [[nodiscard]] const Semaphores& semaphores() const { return context_.semaphores; }

  // Continues all programs that can continue. True if any did. Call it often: the end of moves and waits is detected
  // here. Bounded: 2,000 statements and 8 SCRIPT commands of each program.
  bool follow();
  // A program runs, waits, is held, queued or delayed.
  [[nodiscard]] bool busy() const;
  [[nodiscard]] bool busy(std::string_view robot) const;
  // A running one that continues at a known time: after its rob_program_delays, at a time limit.
  [[nodiscard]] bool waits_for_time() const;
  // The robot's moves belong to a program now; POS_ROB from elsewhere is refused. Not while the program carries out a
  // SCRIPT comment at rest, which may move the robot itself.
  [[nodiscard]] bool moves(std::string_view robot) const;
  // By robot and name.
  [[nodiscard]] std::vector<ProgramStatus> status() const;
  // Its present state; none if it has been ended.
  [[nodiscard]] const std::optional<Deadlock>& deadlock() const { return deadlock_; }
  // Counts programs that failed and deadlocks, also those that have ended since.
  [[nodiscard]] std::uint64_t failures() const { return context_.failures; }
  [[nodiscard]] const std::string& last_failure() const { return context_.last_failure; }
  // The callback must not call the controllers.
  void on_event(std::function<void(const ProgramEvent&)> callback) { context_.event = std::move(callback); }

 private:
  // Refused: the motion does not know the robot, or it has no joints.
  Result<VirtualController*> open(std::string_view robot);
  Result<VirtualController*> find(std::string_view robot) const;
  Result<SignalBoard*> open_signals(std::string_view robot, std::size_t number);
  // A copy: commands of programs may delete robots.
  [[nodiscard]] std::vector<std::shared_ptr<VirtualController>> controllers() const;
  bool follow_once();
  bool serve_semaphores();
  Result<void> declare_semaphores(const Program& program);
  void set_back_semaphores(const LoadedProgram& gone);
  // By another program; `by_occupied_ones`: that runs or is queued.
  [[nodiscard]] bool used(std::string_view semaphore, const LoadedProgram& except, bool by_occupied_ones) const;
  void search_deadlock();
  void recheck_deadlock();
  void report(Deadlock found);
  [[nodiscard]] std::vector<std::string> could_release(std::string_view semaphore) const;

  RunContext context_;
  std::map<std::string, std::shared_ptr<VirtualController>, std::less<>> robots_;
  bool following_ = false;
  bool changed_ = false;   // since the last deadlock search
  Timestamp alone_since_;  // a program waits for what no started one releases; never: none
  std::optional<Deadlock> deadlock_;
};

}  // namespace cellmirror::program
