#include "scripts/runner/script_runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/utc_text.hpp"
#include "scripts/lang/reader.hpp"
#include "scripts/runner/script_run.hpp"

namespace cellmirror::script {

namespace fs = std::filesystem;

namespace {

// What a step may do is bounded by work, not by commands, so that a script with large files or a thousand unknown names
// does not delay messages: a refusal searches the nearest names, a file is checked when loaded.
constexpr std::size_t kWorkOfRefusal = 15;
constexpr std::size_t kBytesOfWork = 256;

constexpr std::string_view kFolder = "scripts";
constexpr std::string_view kExtension = ".spt";

// Relative to the cell folder if the file is in it.
std::string shown_name(const fs::path& path, const fs::path& home) {
  const fs::path relative = path.lexically_relative(home);
  return relative.empty() || *relative.begin() == ".." ? path.string() : relative.string();
}

}  // namespace

ScriptRunner::ScriptRunner(CommandHost host, const KismetHome& home, const Clock& clock, Events events)
    : host_(host), home_(home), clock_(clock), events_(std::move(events)) {
  if (events_.traced) traced_ = std::make_shared<const TraceFunction>(std::move(events_.traced));
}

ScriptRunner::~ScriptRunner() = default;

Result<std::uint64_t> ScriptRunner::start_file(std::string_view name, Diagnostics* findings) {
  auto path = home_.file(kFolder, name, kExtension);
  if (!path) {
    ++counters_.scripts_refused;
    return std::unexpected(std::move(path.error()));
  }
  return start(*path, findings);
}

Result<std::uint64_t> ScriptRunner::start_path(const fs::path& path, Diagnostics* findings) {
  std::error_code error;
  const fs::path canonical = fs::canonical(path, error);
  if (error) {
    ++counters_.scripts_refused;
    return fail(fmt::format("the SCRIPT file {} cannot be opened: {}", path.string(), error.message()));
  }
  return start(canonical, findings);
}

Result<std::uint64_t> ScriptRunner::start(const fs::path& path, Diagnostics* findings) {
  if (runs_.size() == kMaxRuns) {
    ++counters_.scripts_refused;
    return fail(fmt::format("{} SCRIPT files are running already", kMaxRuns),
                "wait until one of them has ended, or end them: STOP_SCRIPT <run>, STOP_ALL");
  }
  Diagnostics own;
  Diagnostics& found = findings == nullptr ? own : *findings;
  auto file = load(path, found);
  for (const Diagnostic& diagnostic : found.all()) remember(diagnostic);
  if (!file) return std::unexpected(std::move(file.error()));
  ++counters_.scripts_started;
  runs_.push_back(std::make_unique<ScriptRun>(++last_id_, std::move(*file)));
  runs_.back()->failures = host_.programs.failures();
  return last_id_;
}

// A file with syntax errors is refused as a whole, so that it is not executed partly. Names are looked up when each
// command is executed, since the commands before it may create them.
Result<std::unique_ptr<ScriptFile>> ScriptRunner::load(const fs::path& path, Diagnostics& findings) {
  const auto refused = [this](Error why) {
    ++counters_.scripts_refused;
    return std::unexpected(std::move(why));
  };
  auto text = read_text_file(path, kMaxScriptBytes);
  if (!text) return refused(std::move(text.error()));
  std::size_t bytes = text->size();
  for (const auto& run : runs_) {
    for (const auto& file : run->stack) bytes += file->text().size();
  }
  work_ += text->size() / kBytesOfWork;
  const std::string name = shown_name(path, home_.root());
  if (bytes > kMaxTextBytes) {
    return refused({fmt::format("{} exceeds the memory of all running SCRIPT files: the limit is {} bytes together",
                                name, kMaxTextBytes),
                    "wait until one of them has ended"});
  }
  const std::size_t errors_before = findings.errors();
  check_script(*text, name, nullptr, findings);
  const std::size_t errors = findings.errors() - errors_before;
  if (errors != 0) {
    const auto first = std::find_if(findings.all().begin(), findings.all().end(),
                                    [](const Diagnostic& d) { return d.severity == Severity::error; });
    return refused({fmt::format("{} has {} error{} and is not run; the first: {}", name, errors, errors == 1 ? "" : "s",
                                first->text()),
                    "`cellmirror check` shows all of them"});
  }
  return std::make_unique<ScriptFile>(path, name, std::move(*text));
}

std::size_t ScriptRunner::step(std::size_t budget) {
  const std::uint64_t received_before = counters_.file.received;
  std::size_t without_progress = 0;
  ended_activities_ = answer_messages();
  work_ = 0;
  stepping_ = true;
  while (work_ < budget && without_progress < runs_.size()) {
    if (next_run_ >= runs_.size()) next_run_ = 0;
    ScriptRun& run = *runs_[next_run_];
    const std::size_t work_before = work_;
    step_run(run, work_ + std::min(kSlice, budget - work_));
    if (!stopped_runs_.empty()) {
      end_stopped_runs();
      without_progress = 0;
      continue;
    }
    if (run.ended()) {
      end_run(next_run_, false);
      without_progress = 0;
      continue;  // the run behind it has moved to its place
    }
    without_progress = work_ == work_before ? without_progress + 1 : 0;
    ++next_run_;
  }
  stepping_ = false;
  return static_cast<std::size_t>(counters_.file.received - received_before) + ended_activities_;
}

bool ScriptRunner::end_wait(ScriptRun& run) {
  if (host_.programs.busy()) return false;
  run.waiting = false;
  ++ended_activities_;
  const Result<void> verdict = host_.programs.verdict(run.failures);
  run.failures = host_.programs.failures();
  if (verdict) {
    ++run.report.counters.done;
    ++counters_.file.done;
    trace_end(run, std::string());
    return true;
  }
  Diagnostics findings;
  findings.error(run.wait_place, verdict.error().what, verdict.error().remedy);
  refuse(run, findings);
  return true;
}

bool ScriptRunner::may_go_on(ScriptRun& run) {
  if (run.waiting && !end_wait(run)) return false;
  if (!run.activity) return true;
  if (run.activity->state() == Activity::State::running) return false;
  const ActivityHandle ended = std::move(run.activity);
  run.activity = nullptr;
  ++ended_activities_;
  if (ended->state() == Activity::State::refused) {
    Diagnostics findings;
    findings.error(run.activity_place, ended->error().what, ended->error().remedy);
    refuse(run, findings);
    return true;
  }
  ++run.report.counters.done;
  ++counters_.file.done;
  trace_end(run, std::string());
  return true;
}

void ScriptRunner::step_run(ScriptRun& run, std::size_t until) {
  if (!may_go_on(run)) return;
  Diagnostics findings;
  while (work_ < until && !run.stack.empty() && !run.waiting && !run.activity && stopped_runs_.empty()) {
    const Position from = run.stack.back()->reader().position();
    const CommandReader::Step step = run.stack.back()->reader().next(&host_.names, command_, findings);
    if (step == CommandReader::Step::end) {
      run.stack.pop_back();
      continue;
    }
    ++work_;
    ++run.report.counters.received;
    ++counters_.file.received;
    const Position& begin = step == CommandReader::Step::command ? command_.begin() : from;
    trace_begin(run, begin.offset, findings.ok() ? begin.line : findings.all().front().place.line);
    if (step == CommandReader::Step::command) {
      execute_command(run);
      note_first_command(run);
      continue;
    }
    refuse(run, findings);
    findings = {};
    note_first_command(run);
  }
}

void ScriptRunner::execute_command(ScriptRun& run) {
  const ScriptFile& file = *run.stack.back();
  const Position place = command_.begin();
  const bool passed_over = events_.withheld && events_.withheld(command_.id(), CommandSource::Kind::file).has_value();
  Outcome outcome = passed_over ? Outcome::done() : script::execute(command_, host_);
  Diagnostics findings;
  if (outcome.kind == Outcome::Kind::wait) {
    run.waiting = true;
    run.wait_place = {file.name(), place.line, place.column};
    return;
  }
  if (outcome.kind == Outcome::Kind::call_script) {
    // The file may be gone from the stack's top afterwards: the name is copied.
    const std::string caller = file.name();
    if (auto called = call(run, outcome.script, findings); !called) {
      findings.error({caller, place.line, place.column}, called.error().what, called.error().remedy);
    }
  }
  if (outcome.kind == Outcome::Kind::stop_runs) {
    if (auto stopped = stop_runs(outcome.run); !stopped) outcome = Outcome::refused(std::move(stopped.error()));
  }
  if (outcome.kind == Outcome::Kind::refused) {
    findings.error({file.name(), place.line, place.column}, std::move(outcome.error.what),
                   std::move(outcome.error.remedy));
  }
  if (!findings.ok()) {
    refuse(run, findings);
    return;
  }
  if (outcome.kind == Outcome::Kind::pending) {
    run.activity = std::move(outcome.activity);
    run.activity_place = {file.name(), place.line, place.column};
    run.tells_later = may_be_wrong_later(command_.id());
    return;
  }
  ++run.report.counters.done;
  ++counters_.file.done;
  trace_end(run, std::string());
}

Result<void> ScriptRunner::call(ScriptRun& run, std::string_view name, Diagnostics& findings) {
  const auto refused = [this](std::string what, std::string remedy = {}) {
    ++counters_.scripts_refused;
    return fail(std::move(what), std::move(remedy));
  };
  auto path = home_.file(kFolder, name, kExtension);
  if (!path) return refused(std::move(path.error().what), std::move(path.error().remedy));
  const std::string shown = shown_name(*path, home_.root());
  if (run.stack.back()->path() == *path) return refused(fmt::format("EXEC_SCRIPT: {} calls itself", shown));
  std::string callers;
  bool on_stack = false;
  for (const auto& file : run.stack) {
    on_stack = on_stack || file->path() == *path;
    if (on_stack) callers += file->name() + " > ";
  }
  if (on_stack) return refused(fmt::format("EXEC_SCRIPT: {} is being executed already: {}{}", shown, callers, shown));
  if (run.stack.size() >= kMaxScriptDepth) {
    return refused(fmt::format("EXEC_SCRIPT: {} nested SCRIPT files are running already", kMaxScriptDepth));
  }
  auto file = load(*path, findings);
  if (!file) return std::unexpected(std::move(file.error()));
  run.stack.push_back(std::move(*file));
  return {};
}

void ScriptRunner::refuse(ScriptRun& run, const Diagnostics& findings) {
  work_ += kWorkOfRefusal;
  ++run.report.counters.refused;
  ++counters_.file.refused;
  run.report.diagnostics.take(findings);
  for (const Diagnostic& diagnostic : findings.all()) remember(diagnostic);
  trace_refused(run, findings);
  if (events_.refused) events_.refused(findings);
}

void ScriptRunner::note_first_command(ScriptRun& run) {
  if (!run.first_command.known()) run.first_command = clock_.now();
}

void ScriptRunner::end_run(std::size_t index, bool stopped) {
  const std::unique_ptr<ScriptRun> run = std::move(runs_[index]);
  runs_.erase(runs_.begin() + static_cast<std::ptrdiff_t>(index));
  ++counters_.scripts_ended;
  ended_.emplace_back(run->report.id, RunProgress{true, run->report.counters, run->first_command});
  if (ended_.size() > kMaxRuns) ended_.pop_front();
  run->report.stopped = stopped;
  trace_end(*run, std::string("its script was stopped meanwhile"));
  leave_activity(*run);
  if (events_.run_ended) events_.run_ended(run->report);
}

// The last command of a stopped run continues; its end counts, and its error is reported.
void ScriptRunner::leave_activity(const ScriptRun& run) {
  if (!run.activity) return;
  if (!run.tells_later) {
    ++counters_.file.done;
    return;
  }
  waiting_messages_.push_back({.from = CommandSource::Kind::file,
                               .activity = run.activity,
                               .place = run.activity_place,
                               .reply = {},
                               .of_stopped_file = true});
}

bool ScriptRunner::stop(std::uint64_t id) {
  const auto found = std::find_if(runs_.begin(), runs_.end(), [id](const auto& run) { return run->report.id == id; });
  if (found == runs_.end()) return false;
  end_run(static_cast<std::size_t>(found - runs_.begin()), true);
  return true;
}

Result<std::size_t> ScriptRunner::stop_runs(std::uint64_t id) {
  std::vector<std::uint64_t> ids;
  for (const auto& run : runs_) {
    if (id == Outcome::kAllRuns || run->report.id == id) ids.push_back(run->report.id);
  }
  if (ids.empty() && id != Outcome::kAllRuns) {
    return fail(fmt::format("STOP_SCRIPT: there is no run {}", id), "`cellmirror status` lists the runs");
  }
  stopped_runs_.insert(stopped_runs_.end(), ids.begin(), ids.end());
  if (id == Outcome::kAllRuns && events_.all_stopped) events_.all_stopped();
  if (!stepping_) end_stopped_runs();
  return ids.size();
}

void ScriptRunner::end_stopped_runs() {
  // Ending one may call back and stop more.
  while (!stopped_runs_.empty()) {
    const std::uint64_t id = stopped_runs_.back();
    stopped_runs_.pop_back();
    stop(id);
  }
}

void ScriptRunner::give_turn(std::uint64_t id) {
  const auto found = std::find_if(runs_.begin(), runs_.end(), [id](const auto& run) { return run->report.id == id; });
  if (found != runs_.end()) next_run_ = static_cast<std::size_t>(found - runs_.begin());
}

RunProgress ScriptRunner::progress(std::uint64_t id) const {
  const auto run = std::find_if(runs_.begin(), runs_.end(), [id](const auto& r) { return r->report.id == id; });
  if (run != runs_.end()) return {false, (*run)->report.counters, (*run)->first_command};
  const auto ended = std::find_if(ended_.begin(), ended_.end(), [id](const auto& entry) { return entry.first == id; });
  if (ended != ended_.end()) return ended->second;
  return {true, {}, {}};
}

void ScriptRunner::stop_all() {
  for (std::size_t count = runs_.size(); count > 0; --count) end_run(count - 1, true);
  refuse_waiting_messages();
}

std::vector<RunStatus> ScriptRunner::runs() const {
  std::vector<RunStatus> all;
  for (const auto& run : runs_) {
    RunStatus status{run->report.id, {}, run->waiting || run->activity != nullptr};
    for (const auto& file : run->stack)
      status.stack.push_back(fmt::format("{}:{}", file->name(), file->reader().position().line));
    all.push_back(std::move(status));
  }
  return all;
}

void ScriptRunner::remember(const Diagnostic& diagnostic) {
  const std::string text = diagnostic.text();
  log_text(LogLevel::warning, "script", text);
  last_errors_.push_back(utc_text(to_wall_clock_ns(clock_.now())) + " " + text);
  if (last_errors_.size() > kKeptErrors) last_errors_.pop_front();
}

}  // namespace cellmirror::script
