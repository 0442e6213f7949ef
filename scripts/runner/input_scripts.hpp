// Runs the SCRIPT files of binary inputs (BININPn_ON.spt, BININPn_OFF.spt, manual 1.2.6): once a change, one after
// another in the order of the changes. Belongs to the thread that owns the cell, as the runner does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <set>
#include <string>

#include "rt_core/base/home.hpp"
#include "rt_core/base/time.hpp"
#include "scripts/runner/script_runner.hpp"

namespace cellmirror::script {

// Of input n, from 1.
struct InputChange {
  std::uint32_t input = 0;
  bool on = false;
  Timestamp since;  // for InputScripts::on_first_command()
};

[[nodiscard]] std::string input_script_name(std::uint32_t input, bool on);

class InputScripts {
 public:
  static constexpr std::size_t kMostWaiting = 4096;

  struct Counters {
    std::uint64_t changes = 0;  // = started + missing + refused + dropped + waiting()
    std::uint64_t started = 0;
    std::uint64_t missing = 0;      // there is no such file: nothing to do
    std::uint64_t refused = 0;      // the file is there but does not run: syntax errors, unreadable
    std::uint64_t dropped = 0;      // the queue was full, or the inputs went offline first
    std::uint64_t with_errors = 0;  // ran, but commands of it were refused
  };
  struct Last {
    std::string file;  // empty: none has run yet
    Timestamp began;
    bool running = false;
    std::uint64_t refused = 0;  // commands
  };

  // Runner, cell folder and clock outlive this.
  InputScripts(ScriptRunner& runner, const KismetHome& home, const Clock& clock)
      : runner_(runner), home_(home), clock_(clock) {}

  // Behind the changes that wait. False where it was dropped.
  bool add(const InputChange& change);
  // Discards waiting changes; the running script continues.
  void forget();
  // Starts the next script when the one before has ended. Often: before and after each step of the runner. True where
  // one was started: it has the runner's next turn.
  bool follow();

  // Receives the time from `since` to the first executed command of a script.
  void on_first_command(std::function<void(Nanoseconds)> callback) { first_command_ = std::move(callback); }

  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }
  [[nodiscard]] bool idle() const { return waiting_.empty() && run_ == 0; }
  [[nodiscard]] const Counters& counters() const { return counters_; }
  [[nodiscard]] const Last& last() const { return last_; }
  // Files that were not found, and still do not exist.
  [[nodiscard]] const std::set<std::string>& missing_files() const { return told_missing_; }

 private:
  bool start(const InputChange& change);
  void check_run();

  ScriptRunner& runner_;
  const KismetHome& home_;
  const Clock& clock_;
  std::deque<InputChange> waiting_;
  bool dropping_ = false;  // the newest change was dropped
  std::uint64_t run_ = 0;  // of the script under way; 0: none
  Timestamp since_;        // of its change; never: its first command was reported
  std::set<std::string> told_missing_;
  std::function<void(Nanoseconds)> first_command_;
  Counters counters_;
  Last last_;
};

}  // namespace cellmirror::script
