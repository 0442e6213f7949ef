#include "scripts/runner/input_scripts.hpp"

#include <fmt/format.h>

#include "rt_core/base/log.hpp"

namespace cellmirror::script {

namespace {

constexpr std::string_view kLogKind = "foot-switches";
// Missing files are still looked up: a flood of such changes must not delay the owner.
constexpr int kFilesInATurn = 64;

}  // namespace

std::string input_script_name(std::uint32_t input, bool on) {
  return fmt::format("BININP{}_{}.spt", input, on ? "ON" : "OFF");
}

bool InputScripts::add(const InputChange& change) {
  ++counters_.changes;
  if (waiting_.size() == kMostWaiting) {
    ++counters_.dropped;
    if (!dropping_) {
      log_warning(kLogKind, "{} and later scripts are dropped: {} changes are waiting already",
                  input_script_name(change.input, change.on), kMostWaiting);
    }
    dropping_ = true;
    return false;
  }
  dropping_ = false;
  waiting_.push_back(change);
  return true;
}

void InputScripts::forget() {
  counters_.dropped += waiting_.size();
  waiting_.clear();
}

bool InputScripts::follow() {
  check_run();
  for (int looked_for = 0; looked_for < kFilesInATurn; ++looked_for) {
    if (run_ != 0 || waiting_.empty() || runner_.full()) return false;
    const InputChange change = waiting_.front();
    waiting_.pop_front();
    if (start(change)) return true;
  }
  return false;
}

void InputScripts::check_run() {
  if (run_ == 0) return;
  const RunProgress progress = runner_.progress(run_);
  if (since_.known() && progress.first_command.known()) {
    if (first_command_) first_command_(progress.first_command - since_);
    since_ = Timestamp{};
  }
  last_.refused = progress.counters.refused;
  if (!progress.ended) return;
  if (progress.counters.refused > 0) ++counters_.with_errors;
  last_.running = false;
  run_ = 0;
}

bool InputScripts::start(const InputChange& change) {
  const std::string name = input_script_name(change.input, change.on);
  if (const auto path = home_.file("scripts", name); !path) {
    ++counters_.missing;
    if (told_missing_.insert(name).second) log_warning(kLogKind, "{} (reported once)", path.error().text());
    return false;
  }
  told_missing_.erase(name);
  last_ = {name, clock_.now(), false, 0};
  const auto id = runner_.start_file(name);
  if (!id) {
    ++counters_.refused;
    log_warning(kLogKind, "{} does not run: {}", name, id.error().text());
    return false;
  }
  ++counters_.started;
  last_.running = true;
  run_ = *id;
  since_ = change.since;
  runner_.give_turn(run_);
  return true;
}

}  // namespace cellmirror::script
