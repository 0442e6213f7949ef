// One run of one program on one robot: drives the machine and carries out its commands. README.md has the states.
// Private to the folder. One thread: the owner of the cell.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "scripts/programs/controller/loaded_program.hpp"
#include "scripts/programs/controller/run_context.hpp"
#include "scripts/programs/program/machine.hpp"

namespace cellmirror::program {

class ProgramRun final : private ProgramWorld {
 public:
  // The robot's moves of the program that have not ended yet, and what is carried out at their ends.
  static constexpr std::size_t kRunAhead = 8;
  static constexpr std::size_t kMostDeferred = 64;
  // In one turn of the owner.
  static constexpr std::size_t kStatements = 2'000;
  static constexpr std::size_t kScripts = 8;

  // Begins at `begin` and its rob_program_delays. The program must fit the robot; backward: it must be reversible.
  // `context` and `signals` outlive the run.
  ProgramRun(RunContext& context, std::string robot, SignalBoard& signals, std::shared_ptr<LoadedProgram> loaded,
             Direction direction, Timestamp begin);

  // A new turn of the owner: the budgets are full again.
  void begin_turn();
  // Continues as far as possible. True if anything was done. Commands of the program may call any other function here.
  bool follow();

  Result<void> hold();
  Result<void> resume();
  Result<void> step(Direction direction);
  // The robot brakes; what the program wanted is forgotten.
  void stop();
  // At once. `at`: what is wrong there; none: it is not the program's.
  void fail_now(std::string why, std::optional<StatementId> at = {});

  // The semaphore for which it waits and could take now; empty: none.
  [[nodiscard]] std::string_view wanted_semaphore() const { return held_ ? std::string_view{} : semaphore_; }
  // The same, also while it is held.
  [[nodiscard]] std::string_view semaphore() const { return semaphore_; }
  // It waits for a known time: rob_program_delays, a time limit.
  [[nodiscard]] bool waits_for_time() const {
    return !held_ && (phase_ == Phase::delayed || (phase_ == Phase::condition && deadline_.known()));
  }
  // Since when it waits.
  [[nodiscard]] Timestamp due() const { return due_; }
  // A SCRIPT comment is being carried out at rest: it may move the robot itself.
  [[nodiscard]] bool has_lent_robot() const { return lent_ && moving_.empty(); }
  // It has the semaphore, since this instant.
  void grant(Timestamp when);

  enum class End : std::uint8_t { none, ended, stopped, failed };
  [[nodiscard]] End end() const { return end_; }
  [[nodiscard]] Timestamp end_time() const { return due_; }  // of a run that has ended
  [[nodiscard]] const std::string& robot() const { return robot_; }
  [[nodiscard]] LoadedProgram& loaded() const { return *loaded_; }
  [[nodiscard]] const std::shared_ptr<LoadedProgram>& loaded_pointer() const { return loaded_; }
  [[nodiscard]] ProgramState state() const;
  [[nodiscard]] std::string waits_for() const;
  [[nodiscard]] std::string step_name() const;
  [[nodiscard]] std::uint32_t line() const;
  [[nodiscard]] Direction direction() const { return machine_.direction(); }
  [[nodiscard]] double elapsed_s() const;
  // Completed without hold or step: its time is the expected time of the next run.
  [[nodiscard]] bool undisturbed() const { return end_ == End::ended && !disturbed_; }

 private:
  // What the run waits for before it fetches the next command.
  enum class Phase : std::uint8_t { delayed, running, condition, semaphore, activity };
  struct Moving {
    std::uint32_t ticket = 0;
    StatementId statement = 0;
    bool move = false;  // else a delay
    bool fly = false;
  };
  struct Deferred {  // at the end of a fly move
    std::uint32_t ticket = 0;
    CanonicalCommand command;
  };
  // When all that was begun has ended.
  struct Closing {
    End end = End::ended;
    std::string why;
    std::optional<StatementId> at;
  };
  // Held, with a request to resume: first the robot must be at rest.
  struct Request {
    bool step = false;
    bool stopping = false;  // the moves ahead are being forgotten
  };
  // Position of the robot in a reversed program.
  struct Turned {
    StatementId check_point = 0;  // it is there or, if it was moving to it at the reversal, before it
    // By direction: the statement at which the program continues; none: after the check point.
    std::array<std::optional<StatementId>, 2> next;
  };
  enum class Done : std::uint8_t { yes, not_yet };

  // program_run.cpp
  bool collect();
  bool go_on();
  bool run_deferred();
  bool begin();
  bool fetch();
  bool close();
  [[nodiscard]] bool rested() const { return moving_.empty() && deferred_.empty() && activities_.empty(); }
  bool check_activities();
  bool check_condition();
  [[nodiscard]] Timestamp deferred_instant() const { return std::max(finished_time_, resumed_); }
  void finish(End end, Timestamp when);
  void fail_behind(StatementId statement, const Error& why);
  [[nodiscard]] std::string error_text(StatementId statement, const Error& why) const;
  void report(ProgramEvent::Kind kind, Timestamp when, std::string text = {}, std::uint32_t ticket = 0);
  void report_command(ProgramEvent::Kind kind, Timestamp when, const CanonicalCommand& command,
                      std::uint32_t ticket = 0);
  [[nodiscard]] std::optional<StatementId> statement() const;
  [[nodiscard]] std::optional<StatementId> failed_statement() const;

  // program_run_commands.cpp
  bool carry_out();
  Done begin_to(const MoveCommand& move, const CanonicalCommand& command);
  Done begin_to(const DelayCommand& delay, const CanonicalCommand& command);
  Done begin_to(const ToolCommand& tool, const CanonicalCommand& command);
  Done begin_to(const WaitCommand& wait, const CanonicalCommand& command);
  Done begin_to(const AcquireCommand& acquire, const CanonicalCommand& command);
  Done begin_to(const PauseCommand& pause, const CanonicalCommand& command);
  Done begin_to(const RestCommand& rest, const CanonicalCommand& command);
  // Outputs, releases, comments: at the end of the moves before, for which the program does not wait where they fly.
  Done carry_out_at_end(const CanonicalCommand& command);
  [[nodiscard]] bool moved_by_comment(const CanonicalCommand& command) const;
  [[nodiscard]] bool may_execute(const CanonicalCommand& command) const;
  void execute(const CanonicalCommand& command, Timestamp when);
  Result<void> execute(const OutputCommand& output, Timestamp when);
  Result<void> execute(const ReleaseCommand& release, Timestamp when);
  Result<void> execute(const ScriptCommand& script, StatementId statement, Timestamp when);
  std::string keep_semaphores(End end);
  [[nodiscard]] bool room() const;
  void put_ahead(const Result<std::uint32_t>& ticket, const CanonicalCommand& command, bool fly);

  // program_run_hold.cpp
  void hold_here();
  void go();
  bool settle();
  Result<void> turn(Direction direction);
  [[nodiscard]] std::optional<StatementId> first_undone(Direction direction) const;
  void forget_ahead();
  void put_machine_at_robot();
  [[nodiscard]] bool step_is_over() const;
  [[nodiscard]] std::uint32_t first_move_ahead() const;

  // ProgramWorld
  [[nodiscard]] JointValues joints() const override { return context_.motion.joints(robot_); }
  [[nodiscard]] Result<Pose> position() const override { return context_.motion.position(robot_); }
  [[nodiscard]] bool digital_input(std::size_t number) const override { return signals_.digital_inputs[number]; }
  [[nodiscard]] double analogue_input(std::size_t number) const override { return signals_.analogue_inputs[number]; }
  [[nodiscard]] bool digital_output(std::size_t number) const override { return signals_.digital_outputs[number]; }
  [[nodiscard]] double analogue_output(std::size_t number) const override { return signals_.analogue_outputs[number]; }

  RunContext& context_;
  std::string robot_;
  SignalBoard& signals_;
  std::shared_ptr<LoadedProgram> loaded_;
  Direction direction_;
  Machine machine_;

  Phase phase_ = Phase::delayed;
  std::optional<CanonicalCommand> pending_;  // given by the machine, not carried out yet
  std::deque<Moving> moving_;                // in the tick
  std::uint32_t finished_ = 0;               // ticket of the newest move that has ended
  Timestamp finished_time_;
  std::optional<StatementId> at_;      // statement of the newest move that has ended
  std::optional<StatementId> newest_;  // statement of the newest command that was carried out or begun
  std::deque<Deferred> deferred_;
  std::deque<std::pair<ActivityHandle, StatementId>> activities_;
  std::string semaphore_;
  std::vector<std::string> taken_;           // semaphores that it has acquired and not released, each as often
  std::optional<CanonicalCommand> waiting_;  // condition, semaphore: the command
  Timestamp deadline_;                       // condition: of its timeout; never: none
  std::optional<Closing> closing_;
  End end_ = End::none;
  bool lent_ = false;
  bool tool_set_ = false;

  Timestamp started_;
  Timestamp until_;  // delayed
  // The instant that the program has come to: that at which the newest of what it waited for happened. Behind the
  // clock by the time that it takes to notice.
  Timestamp due_;

  bool held_ = false;
  bool disturbed_ = false;
  Timestamp held_since_;
  Timestamp resumed_;
  Nanoseconds held_time_{0};
  std::optional<Request> request_;
  bool stepping_ = false;
  std::uint32_t step_ticket_ = 0;  // the move of this step; 0: none yet
  bool forget_ahead_ = false;      // turned round: what is ahead of the robot is not wanted any more
  std::optional<Direction> went_;  // turned round from this direction, and what is ahead has not been forgotten yet
  std::optional<Turned> turned_;   // until the first move behind it

  std::size_t statements_left_ = kStatements;
  std::size_t scripts_left_ = kScripts;
};

}  // namespace cellmirror::program
