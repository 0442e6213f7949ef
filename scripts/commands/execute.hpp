// Executes one parsed command on the gateway. Called by the thread that owns the cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "scripts/commands/host.hpp"
#include "scripts/lang/parsed_command.hpp"

namespace cellmirror::script {

// What came of a command.
struct Outcome {
  enum class Kind : std::uint8_t {
    done,
    refused,      // `error` says why and what to do; nothing was changed
    call_script,  // EXEC_SCRIPT: the runner calls `script`
    wait,         // WAIT: the runner suspends the script
    stop_runs,    // STOP_SCRIPT, STOP_ALL: the runner ends the run `run`, or all of them
    pending,      // begun; done or refused when `activity` ends
  };

  Kind kind = Kind::done;
  Error error;
  std::string_view script;  // points into the command's text
  ActivityHandle activity;
  std::string remark;  // text of the answer; empty: none
  std::uint64_t run = kAllRuns;

  static constexpr std::uint64_t kAllRuns = 0;

  static Outcome done() { return {}; }
  static Outcome refused(Error why) { return {Kind::refused, std::move(why), {}, {}, {}, kAllRuns}; }
  static Outcome pending(ActivityHandle activity) { return {Kind::pending, {}, {}, std::move(activity), {}, kAllRuns}; }
  static Outcome of(Result<void> result) { return result ? done() : refused(std::move(result.error())); }
  static Outcome stop_runs(std::uint64_t run) { return {Kind::stop_runs, {}, {}, {}, {}, run}; }
  static Outcome with_remark(Result<std::string> result) {
    if (!result) return refused(std::move(result.error()));
    Outcome outcome;
    outcome.remark = *std::move(result);
    return outcome;
  }
};

// The command must have been parsed with host.names.
[[nodiscard]] Outcome execute(const ParsedCommand& command, CommandHost& host);

// Whether a handler is registered for the form; all commands of the table have one, conventions have none.
[[nodiscard]] bool has_handler(FormId id);

}  // namespace cellmirror::script
