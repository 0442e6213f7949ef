// The virtual controller of one robot: its programs, the one that runs, those that are queued, its inputs and outputs.
// Private to the folder. One thread: the owner of the cell.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "scripts/programs/controller/loaded_program.hpp"
#include "scripts/programs/controller/program_run.hpp"
#include "scripts/programs/controller/run_context.hpp"

namespace cellmirror::program {

class VirtualController {
 public:
  static constexpr std::size_t kMostPrograms = 64;
  static constexpr std::size_t kMostQueued = 64;

  // The context outlives it.
  VirtualController(RunContext& context, std::string robot) : context_(context), robot_(std::move(robot)) {}

  // As Controllers says.
  [[nodiscard]] Result<void> check_load(std::string_view name, const Program& program) const;
  void put(std::string_view name, std::shared_ptr<const Program> program);  // has been checked
  Result<void> run(std::string_view name, bool exec_wait, Direction direction);
  Result<std::shared_ptr<LoadedProgram>> remove(std::string_view name);
  Result<void> hold();
  Result<void> resume();
  Result<void> step(Direction direction);
  Result<void> stop();
  void cancel(const std::string& why);

  void begin_turn();
  bool follow();

  // Null: none.
  [[nodiscard]] ProgramRun* run() const { return run_.get(); }
  [[nodiscard]] const std::map<std::string, std::shared_ptr<LoadedProgram>, std::less<>>& programs() const {
    return programs_;
  }
  struct Queued {
    std::shared_ptr<LoadedProgram> program;
    Direction direction = Direction::forward;
  };
  [[nodiscard]] const std::deque<Queued>& queue() const { return queue_; }
  [[nodiscard]] const std::string& robot() const { return robot_; }
  [[nodiscard]] SignalBoard& signals() { return signals_; }
  [[nodiscard]] bool busy() const { return run_ != nullptr || !queue_.empty(); }
  [[nodiscard]] bool occupied(const LoadedProgram& program) const;  // runs or is queued
  void append_status(std::vector<ProgramStatus>& statuses) const;

 private:
  Result<std::shared_ptr<LoadedProgram>> find(std::string_view name) const;
  [[nodiscard]] Error none_runs() const;
  void begin(const Queued& what, Timestamp when);
  void end_run();
  void begin_next(Timestamp when);
  void note_failure(const LoadedProgram& program);
  void drop_queue(ProgramState state, const std::string& why);

  RunContext& context_;
  std::string robot_;
  SignalBoard signals_;
  std::map<std::string, std::shared_ptr<LoadedProgram>, std::less<>> programs_;
  std::deque<Queued> queue_;
  std::shared_ptr<ProgramRun> run_;  // shared: a command of the program may end it while it is being carried out
};

}  // namespace cellmirror::program
