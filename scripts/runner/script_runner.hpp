// Runs SCRIPT files and messages for the thread that owns the cell: step by step, several files side by side, so that
// a long or waiting script never keeps messages waiting. Every function is called from that one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "scripts/commands/execute.hpp"
#include "scripts/commands/host.hpp"
#include "scripts/lang/parsed_command.hpp"
#include "scripts/runner/command_trace.hpp"
#include "scripts/runner/script_command.hpp"

namespace cellmirror::script {

class ScriptFile;
class ScriptRun;

// received = done + refused, but for a command that is being executed.
struct SourceCounters {
  std::uint64_t received = 0;
  std::uint64_t done = 0;
  std::uint64_t refused = 0;
};

struct ScriptCounters {
  SourceCounters file;
  SourceCounters message;
  SourceCounters program;  // comments of robot programs
  std::uint64_t scripts_started = 0;
  std::uint64_t scripts_ended = 0;
  std::uint64_t scripts_refused = 0;  // missing, unreadable, with syntax errors, recursive, ...

  [[nodiscard]] SourceCounters all() const {
    return {file.received + message.received + program.received, file.done + message.done + program.done,
            file.refused + message.refused + program.refused};
  }
};

// A run that has ended (or was stopped).
struct RunReport {
  std::uint64_t id = 0;
  std::string file;  // relative to the cell folder, as in diagnostics
  SourceCounters counters;
  bool stopped = false;
  Diagnostics diagnostics;
};

// A run that is under way.
struct RunStatus {
  std::uint64_t id = 0;
  std::vector<std::string> stack;  // "scripts/a.spt:12", the outermost first
  bool waiting = false;            // in WAIT, or for a robot to arrive
};

// What has come of a run so far. A run that has ended is remembered until others have ended too (kMaxRuns of them).
struct RunProgress {
  bool ended = false;
  SourceCounters counters;
  Timestamp first_command;  // when it had been executed; never: none yet, or the script has none
};

class ScriptRunner {
 public:
  static constexpr std::size_t kMaxRuns = 32;                        // side by side
  static constexpr std::size_t kMaxRunsOfMessages = 16;              // of these, started by messages or programs
  static constexpr std::size_t kMaxRunsOfPage = 12;                  // started by the monitor page
  static constexpr std::size_t kMaxTextBytes = 128UL * 1024 * 1024;  // of all files of all runs together
  static constexpr std::size_t kKeptErrors = 20;                     // last_errors
  static constexpr std::size_t kSlice = 64;                          // commands of one run before the next has its turn

  using TraceFunction = std::function<void(CommandTrace&&)>;
  // Empty: not wanted.
  struct Events {
    std::function<void(const RunReport&)> run_ended = {};
    // A command of a file was refused.
    std::function<void(const Diagnostics&)> refused = {};
    // STOP_ALL: what still waits to be started by others is to be discarded.
    std::function<void()> all_stopped = {};
    // Why a command is not to be executed here; none: it is. Commands of files are passed over then, others refused.
    std::function<std::optional<Error>(FormId command, CommandSource::Kind from)> withheld = {};
    // A command is done or refused, whatever its source; also called by replies that outlive the runner.
    TraceFunction traced = {};
  };

  // The host, the cell folder and the clock must outlive the runner. The clock dates errors and first commands.
  ScriptRunner(CommandHost host, const KismetHome& home, const Clock& clock, Events events);
  ScriptRunner(CommandHost host, const KismetHome& home, const Clock& clock)
      : ScriptRunner(host, home, clock, Events()) {}
  ~ScriptRunner();
  ScriptRunner(const ScriptRunner&) = delete;
  ScriptRunner& operator=(const ScriptRunner&) = delete;

  // Starts a file of the cell folder's scripts/ (default extension .spt) as a run of its own; nothing of it has been
  // executed yet when the call returns. Refused: missing, unreadable, outside the cell folder, too large, with syntax
  // errors (nothing of it runs; the diagnostics are in the error's text and, individually, in `findings`). Returns the
  // run's id.
  Result<std::uint64_t> start_file(std::string_view name, Diagnostics* findings = nullptr);
  // The same for a file that the operator named on the command line: it may be anywhere.
  Result<std::uint64_t> start_path(const std::filesystem::path& path, Diagnostics* findings = nullptr);

  // Executes one command now, whatever the files do; returns a text for the acknowledgement. EXEC_SCRIPT starts the
  // file and returns when it was accepted, a motion when it has begun; WAIT is refused. `source` names the sender in
  // errors. A robot program that cannot be loaded or run later is counted and remembered as refused then.
  Result<std::string> execute_message(std::string_view text, std::string_view source = "message",
                                      CommandSource::Kind from = CommandSource::Kind::message);
  // The same for a client that gets one answer: now, or within a step() when the command's activity has ended.
  void execute_message(std::string_view text, std::string_view source, CommandReply reply,
                       CommandSource::Kind from = CommandSource::Kind::message);
  // The same for a command from outside, whether its sender is answered or not.
  void execute(ScriptCommand command);

  // A command from inside a robot program, executed now as a message is; `source` names program and line in errors.
  // WAIT and TF_WAIT are refused: the program would wait for itself. The activity is that of what the command began;
  // null: it is done.
  Result<ActivityHandle> execute_program_command(std::string_view text, std::string_view source);

  // Answers the messages whose activity has ended. Then executes up to `budget` commands of the files, in turn; fewer
  // if they are refused (each counts 16) or load files (each 256 bytes count 1). Returns how many commands began or
  // ended. 0: every run waits, or there is none.
  std::size_t step(std::size_t budget);

  [[nodiscard]] bool idle() const { return runs_.empty(); }
  [[nodiscard]] std::vector<RunStatus> runs() const;
  // Ends a run, or all of them, before their next command; stop_all() also refuses the messages that wait, since the
  // gateway ends. A robot program that the run was loading or starting still counts, and a later refusal is reported.
  bool stop(std::uint64_t id);
  // The run is the next one to execute commands.
  void give_turn(std::uint64_t id);
  // Of a run that is under way, or has ended not long ago; unknown ones have ended.
  [[nodiscard]] RunProgress progress(std::uint64_t id) const;
  // No other file can be started.
  [[nodiscard]] bool full() const { return runs_.size() == kMaxRuns; }
  void stop_all();

  [[nodiscard]] const ScriptCounters& counters() const { return counters_; }
  // "2026-11-21T10:00:00Z scripts/a.spt:3:1: error: ...", the newest last; at most kKeptErrors.
  [[nodiscard]] std::vector<std::string> last_errors() const { return {last_errors_.begin(), last_errors_.end()}; }

 private:
  // A message that is answered or counted when its activity has ended, a command of a robot program, or of a script
  // that was stopped. At most one a robot runs, of TF_WAIT there is one per client, and the number of loads is bounded,
  // so they stay few.
  struct WaitingMessage {
    CommandSource::Kind from;
    ActivityHandle activity;
    Place place;
    CommandReply reply;
    bool of_stopped_file = false;  // where it is refused, Events::refused is called
  };

  Result<std::uint64_t> start(const std::filesystem::path& path, Diagnostics* findings);
  Result<std::unique_ptr<ScriptFile>> load(const std::filesystem::path& path, Diagnostics& findings);
  void step_run(ScriptRun& run, std::size_t until);
  // Ends a WAIT that need not wait any longer. False: it waits on.
  bool end_wait(ScriptRun& run);
  // False while the run waits; ends the command it waited for.
  bool may_go_on(ScriptRun& run);
  void execute_command(ScriptRun& run);
  // STOP_SCRIPT and STOP_ALL. How many runs end; refused where there is no such run.
  Result<std::size_t> stop_runs(std::uint64_t id);
  void end_stopped_runs();
  Result<void> call(ScriptRun& run, std::string_view name, Diagnostics& findings);
  void refuse(ScriptRun& run, const Diagnostics& findings);
  // The answer; none where `activity` was set: it comes when that ends.
  std::optional<Result<std::string>> begin_message(ParsedCommand& command, CommandSource::Kind from,
                                                   std::string_view text, std::string_view source,
                                                   ActivityHandle& activity);
  Result<std::string> accept_message(const Outcome& outcome, CommandSource::Kind from);
  Result<void> room_for_run(CommandSource::Kind from);
  void count_message(CommandSource::Kind from, const Result<std::string>& result, const Place& place);
  [[nodiscard]] SourceCounters& counters_of(CommandSource::Kind from);
  std::size_t answer_messages();
  [[nodiscard]] static bool may_be_wrong_later(FormId id);
  void refuse_waiting_messages();
  void end_message(WaitingMessage& message, const Result<std::string>& result);
  void end_run(std::size_t index, bool stopped);
  void leave_activity(const ScriptRun& run);
  void note_first_command(ScriptRun& run);
  void remember(const Diagnostic& diagnostic);
  // The command of a file from `from` to the reader's place is under way; trace_end() says what became of it.
  void trace_begin(ScriptRun& run, std::size_t from, int line);
  void trace_end(ScriptRun& run, const Result<std::string>& result);
  void trace_refused(ScriptRun& run, const Diagnostics& findings);
  [[nodiscard]] CommandTrace trace_of(const CommandSource& source, std::string text, Timestamp began,
                                      const Result<std::string>& result) const;
  // Reports what became of the command, then answers it.
  [[nodiscard]] CommandReply traced(const ScriptCommand& command, CommandReply reply) const;

  CommandHost host_;
  const KismetHome& home_;
  const Clock& clock_;
  std::vector<std::unique_ptr<ScriptRun>> runs_;
  std::vector<WaitingMessage> waiting_messages_;
  // To be ended: a command that runs inside of step() cannot end its own run at once.
  std::vector<std::uint64_t> stopped_runs_;
  bool stepping_ = false;
  std::deque<std::pair<std::uint64_t, RunProgress>> ended_;  // newest last
  std::size_t next_run_ = 0;
  std::size_t work_ = 0;              // done in this step
  std::size_t ended_activities_ = 0;  // in this step
  std::uint64_t last_id_ = 0;
  ScriptCounters counters_;
  std::deque<std::string> last_errors_;
  Events events_;
  std::shared_ptr<const TraceFunction> traced_;  // Events::traced; null: not wanted; replies share it
  ParsedCommand command_;                        // reused
  ParsedCommand program_command_;  // likewise: a command of a file may resume a program, which executes its own
};

}  // namespace cellmirror::script
