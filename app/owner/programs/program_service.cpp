#include "app/owner/programs/program_service.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/owner/programs/program_files.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/text.hpp"
#include "scripts/programs/languages/languages.hpp"

namespace cellmirror::app {

namespace {

constexpr std::string_view kProgramLog = "programs";
constexpr std::size_t kLoggedFindings = 20;          // of one program
constexpr std::uintmax_t kReadAtOnce = 16UL * 1024;  // bytes: less than a millisecond

bool has_the_robot(program::ProgramState state) {
  switch (state) {
    case program::ProgramState::delayed:
    case program::ProgramState::running:
    case program::ProgramState::waiting:
    case program::ProgramState::held:
      return true;
    default:
      return false;
  }
}

}  // namespace

ProgramService::ProgramService(Parts parts)
    : parts_(std::move(parts)),
      controllers_(parts_.moves, *this, parts_.clock),
      recordings_(parts_.cell, parts_.home, parts_.fleet, parts_.clock),
      loads_([&home = parts_.home](const program::Language& language, const std::filesystem::path& path) {
        return read_program(home, language, path);
      }) {
  controllers_.on_event([this](const program::ProgramEvent& event) { note(event); });
}

Result<void> ProgramService::check_robot(std::string_view robot) const {
  if (parts_.cell.robot(robot) != nullptr) return {};
  return std::unexpected(parts_.cell.explain_robot(robot));
}

Result<void> ProgramService::set_language(std::string_view language) {
  const auto found = program::find_language(language);
  if (!found) return std::unexpected(found.error());
  language_ = (*found)->name;
  return {};
}

Result<ActivityHandle> ProgramService::load_program(std::string_view program, std::string_view robot) {
  if (auto checked = check_robot(robot); !checked) return std::unexpected(checked.error());
  const auto language = program::find_language(language_);
  if (!language) return std::unexpected(language.error());
  auto path = find_program_file(parts_.home, **language, program);
  if (!path) return std::unexpected(path.error());
  std::error_code error;
  const bool long_one = std::filesystem::file_size(*path, error) > kReadAtOnce;
  if (parts_.read_aside && (long_one || loads_.under_way(program, robot))) {
    return loads_.begin(program, robot, **language, *std::move(path));
  }
  if (auto loaded = accept(program, robot, read_program(parts_.home, **language, *path)); !loaded)
    return std::unexpected(loaded.error());
  return ActivityHandle();
}

Result<void> ProgramService::accept(std::string_view program, std::string_view robot, ProgramText text) {
  const std::vector<Diagnostic>& findings = text.findings.all();
  const std::size_t logged = std::min(findings.size(), kLoggedFindings);
  for (std::size_t i = 0; i < logged; ++i) log_text(LogLevel::warning, kProgramLog, findings[i].text());
  if (!text.program) return std::unexpected(std::move(text.program.error()));
  return controllers_.load(robot, program, *std::move(text.program));
}

// A program that is being loaded begins when it is there, so that commands that nobody waits for keep their order.
Result<ActivityHandle> ProgramService::run_program(std::string_view program, std::string_view robot,
                                                   ProgramBegin begin) {
  if (auto checked = check_robot(robot); !checked) return std::unexpected(checked.error());
  if (loads_.has_to_wait(program, robot)) return loads_.add_run(program, robot, begin);
  if (auto begun = begin_run(program, robot, begin); !begun) return std::unexpected(begun.error());
  return ActivityHandle();
}

Result<void> ProgramService::begin_run(std::string_view program, std::string_view robot, ProgramBegin begin) {
  const bool idle = !controllers_.busy(robot);
  const auto when =
      begin == ProgramBegin::exec_wait ? program::Controllers::Begin::exec_wait : program::Controllers::Begin::now;
  const auto direction = begin == ProgramBegin::backward ? program::Direction::backward : program::Direction::forward;
  if (auto begun = controllers_.run(robot, program, when, direction); !begun) return begun;
  if (idle) failed_of_robot_.erase(std::string(robot));
  return {};
}

bool ProgramService::end_loads() {
  bool any = false;
  while (auto ended = loads_.take()) {
    any = true;
    const std::string& program = ended->what.program;
    const std::string& robot = ended->what.robot;
    auto loaded = check_robot(robot);  // it may have been deleted
    if (loaded) loaded = accept(program, robot, std::move(ended->text));
    if (loaded) {
      ended->activity->finish();
    } else {
      ended->activity->refuse(loaded.error());
    }
    for (const ProgramLoads::Run& run : ended->runs) {
      if (!loaded && run.program == program) {
        run.activity->refuse(loaded.error());
      } else {
        begin_waiting_run(run, robot);
      }
    }
  }
  return any;
}

void ProgramService::begin_waiting_run(const ProgramLoads::Run& run, std::string_view robot) {
  const bool first = !controllers_.busy(robot);
  auto begun = begin_run(run.program, robot, run.begin);
  if (begun && first && run.held) begun = controllers_.hold(robot);
  if (begun) {
    run.activity->finish();
  } else {
    run.activity->refuse(begun.error());
  }
}

Result<void> ProgramService::delete_program(std::string_view program, std::string_view robot) {
  // One that is being loaded for the first time is not there yet. What is refused changes nothing.
  const bool there = loaded(program, robot) || !loads_.under_way(program, robot);
  if (auto removed = controllers_.remove(robot, program); !removed && there) return removed;
  for (const ProgramLoads::Run& run : loads_.cancel(program, robot, {"cancelled by TF_DELETE", {}}))
    begin_waiting_run(run, robot);
  return {};
}

bool ProgramService::loaded(std::string_view program, std::string_view robot) const {
  return std::ranges::any_of(controllers_.status(), [&](const program::ProgramStatus& status) {
    return status.robot == robot && status.name == program;
  });
}

// A program that waits until it is loaded begins held, and TF_RESUME takes that back.
Result<void> ProgramService::hold_program(std::string_view robot) {
  if (controllers_.busy(robot) || !loads_.runs_wait(robot)) return controllers_.hold(robot);
  loads_.hold_runs(robot, true);
  return {};
}
Result<void> ProgramService::resume_program(std::string_view robot) {
  const bool released = loads_.hold_runs(robot, false);
  auto resumed = controllers_.resume(robot);
  if (released && !controllers_.busy(robot)) return {};
  return resumed;
}
Result<void> ProgramService::step_program(std::string_view robot, bool backward) {
  return controllers_.step(robot, backward ? program::Direction::backward : program::Direction::forward);
}
Result<void> ProgramService::stop_programs(std::string_view robot) {
  const bool waited = loads_.give_up_runs(robot, {"stopped by TF_STOP", {}});
  auto stopped = controllers_.stop(robot);
  if (waited) return {};
  return stopped;
}

Result<ActivityHandle> ProgramService::await_programs(std::string_view robot) {
  if (auto checked = check_robot(robot); !checked) return std::unexpected(checked.error());
  if (awaiting_.size() == kMostAwaiting) {
    return fail(fmt::format("{} wait for robot programs already", kMostAwaiting), "wait until some of them have ended");
  }
  awaiting_.push_back({std::string(robot), std::make_shared<Activity>()});
  ActivityHandle activity = awaiting_.back().activity;
  answer_awaiting();
  if (activity->state() == Activity::State::refused) return std::unexpected(activity->error());
  return activity->state() == Activity::State::done ? ActivityHandle() : activity;
}

Result<void> ProgramService::record_program(std::string_view program, std::string_view robot, RecordStep step,
                                            std::string_view point) {
  switch (step) {
    case RecordStep::start:
      return recordings_.start(program, robot, language_);
    case RecordStep::point:
      return recordings_.point(program, robot, point);
    case RecordStep::stop:
      return recordings_.stop(program, robot);
  }
  return {};
}

Result<void> ProgramService::set_digital_input(std::string_view robot, std::size_t number, bool on) {
  if (auto checked = check_robot(robot); !checked) return checked;
  return controllers_.set_digital_input(robot, number, on);
}

Result<void> ProgramService::set_analogue_input(std::string_view robot, std::size_t number, double value) {
  if (auto checked = check_robot(robot); !checked) return checked;
  return controllers_.set_analogue_input(robot, number, value);
}

// Programs in a deadlock wait for ever: WAIT reports it and does not wait with them.
bool ProgramService::busy() const {
  return parts_.motion.moving() || parts_.display.busy() || loads_.runs_wait() ||
         (controllers_.busy() && !controllers_.deadlock());
}

Result<void> ProgramService::verdict(std::uint64_t since) const {
  if (const auto& deadlock = controllers_.deadlock()) return fail(deadlock->text(), "TF_STOP ends programs that wait");
  if (since >= failures_) return {};
  const std::uint64_t count = failures_ - since;
  if (count == 1) return fail(failed_.back());
  std::string all;
  const std::size_t shown = std::min<std::size_t>(count, failed_.size());
  for (std::size_t i = failed_.size() - shown; i < failed_.size(); ++i) all += (all.empty() ? "" : " | ") + failed_[i];
  return fail(fmt::format("{} robot programs failed: {}", count, all));
}

Result<ActivityHandle> ProgramService::execute(std::string_view text, std::string_view source) {
  CELLMIRROR_EXPECTS(parts_.runner);
  return parts_.runner().execute_program_command(text, source);
}

bool ProgramService::follow() {
  recordings_.follow();
  const bool loaded = end_loads();
  const bool any = controllers_.follow() || loaded;
  if (!awaiting_.empty()) answer_awaiting();
  return any;
}

void ProgramService::follow_cell() {
  recordings_.follow_cell();
  std::vector<std::string> gone;
  for (const program::ProgramStatus& status : controllers_.status()) {
    if (parts_.cell.robot(status.robot) == nullptr && (gone.empty() || gone.back() != status.robot))
      gone.push_back(status.robot);
  }
  const auto why = [](std::string_view robot) { return Error{fmt::format("the robot {} was deleted", robot), {}}; };
  // First, so that waiters for a load get this reason and not that a program before it has failed.
  for (const LoadSnapshot& load : loads_.snapshots()) {
    if (parts_.cell.robot(load.robot) == nullptr) loads_.give_up_robot(load.robot, why(load.robot));
  }
  for (const std::string& robot : gone) controllers_.cancel(robot, why(robot), true);
}

void ProgramService::cancel(std::string_view robot, const Error& why) {
  give_up_waiting(robot, why);
  controllers_.cancel(robot, why, false);
}

void ProgramService::shut_down() {
  controllers_.stop_all();
  loads_.give_up_all({"the gateway ends", {}});
  for (const Awaiting& waiting : awaiting_) waiting.activity->refuse({"the gateway ends", {}});
  awaiting_.clear();
}

void ProgramService::note(const program::ProgramEvent& event) {
  using Kind = program::ProgramEvent::Kind;
  if (event.kind == Kind::failed || event.kind == Kind::deadlock) log_warning(kProgramLog, "{}", event.text);
  // A deadlock fails those who wait while it lasts (verdict()): once it is ended, the verdict is good.
  if (event.kind == Kind::failed) {
    ++failures_;
    failed_.push_back(event.text);
    if (failed_.size() > kKeptFailures) failed_.pop_front();
  }
  if (event.kind == Kind::failed) {
    // The first: those that were queued behind it fail for no reason of their own.
    failed_of_robot_.try_emplace(event.robot, event.text);
    loads_.give_up_queued_runs(event.robot, {fmt::format("{} before it has failed", event.program), {}});
  }
  if (event.kind == Kind::started || event.kind == Kind::ended || event.kind == Kind::stopped) {
    log_info(kProgramLog, "{} of {} {}{}{}", event.program, event.robot,
             event.kind == Kind::started ? "started"
             : event.kind == Kind::ended ? "ended"
                                         : "was stopped",
             event.text.empty() ? "" : " ", event.text);
  }
  if (parts_.event) parts_.event(event);
}

void ProgramService::answer_awaiting() {
  const auto& deadlock = controllers_.deadlock();
  std::erase_if(awaiting_, [&](const Awaiting& waiting) {
    const auto stuck = [&](const program::Deadlock::Waiting& program) { return program.robot == waiting.robot; };
    if (deadlock && std::ranges::any_of(deadlock->waiting, stuck)) {
      waiting.activity->refuse({deadlock->text(), "TF_STOP ends programs that wait"});
      return true;
    }
    if (controllers_.busy(waiting.robot) || loads_.runs_wait(waiting.robot)) return false;
    const auto failed = failed_of_robot_.find(waiting.robot);
    if (failed == failed_of_robot_.end()) {
      waiting.activity->finish();
    } else {
      waiting.activity->refuse({failed->second, {}});
    }
    return true;
  });
}

std::string ProgramService::moving_program(std::string_view robot) const {
  if (!controllers_.moves(robot)) return {};
  for (const program::ProgramStatus& status : controllers_.status()) {
    if (status.robot == robot && has_the_robot(status.state)) return status.name;
  }
  return {};
}

SignalSnapshot ProgramService::signals_of(const RobotModel& robot) const {
  SignalSnapshot snapshot;
  snapshot.robot = robot.id();
  const program::SignalBoard* board = controllers_.signals(robot.id());
  if (board == nullptr) return snapshot;
  for (std::size_t number = 1; number <= program::kMostPorts; ++number) {
    if (board->digital_inputs[number]) snapshot.inputs_on.push_back(number);
    if (board->digital_outputs[number]) snapshot.outputs_on.push_back(number);
    if (board->analogue_inputs[number] != 0)
      snapshot.analogue_inputs.emplace_back(number, board->analogue_inputs[number]);
    if (board->analogue_outputs[number] != 0)
      snapshot.analogue_outputs.emplace_back(number, board->analogue_outputs[number]);
  }
  return snapshot;
}

ProgramsSnapshot ProgramService::snapshot() const {
  ProgramsSnapshot snapshot;
  snapshot.programs = controllers_.status();
  snapshot.loading = loads_.snapshots();
  snapshot.deadlock = controllers_.deadlock();
  for (const auto& [name, count] : controllers_.semaphores().counts()) snapshot.semaphores.emplace_back(name, count);
  for (const std::string& id : parts_.cell.robot_ids()) {
    SignalSnapshot signals = signals_of(*parts_.cell.robot(id));
    if (!signals.inputs_on.empty() || !signals.outputs_on.empty() || !signals.analogue_inputs.empty() ||
        !signals.analogue_outputs.empty()) {
      snapshot.signals.push_back(std::move(signals));
    }
  }
  snapshot.recordings = recordings_.snapshots();
  snapshot.failures = failures_;
  if (!failed_.empty()) snapshot.last_failure = failed_.back();
  return snapshot;
}

}  // namespace cellmirror::app
