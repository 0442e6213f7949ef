#include "app/simulation/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <utility>

#include "app/simulation/collision_watch.hpp"
#include "app/simulation/motion_recorder.hpp"
#include "app/simulation/off_line_gateway.hpp"
#include "app/simulation/off_line_tissue.hpp"
#include "app/simulation/program_recorder.hpp"

namespace cellmirror::app {

namespace {

constexpr double kStillInDeadlock = 1.0;  // s; programs that wait for each other wait for ever

Nanoseconds nanoseconds(double time_s) { return Nanoseconds(std::llround(1e9 * time_s)); }

// Of this thread.
double processor_time_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

class Simulation {
 public:
  // `tissue` may be null.
  Simulation(LoadedCell cell, const SimulationOptions& options, std::unique_ptr<OffLineTissue> tissue)
      : options_(options),
        period_(nanoseconds(1.0 / cell.loop.rate_hz)),
        motion_(OffLineGateway::kBegin, period_),
        programs_(OffLineGateway::kBegin, motion_),
        collisions_(OffLineGateway::kBegin, std::max(nanoseconds(options.collision_period_s), period_)),
        tissue_(std::move(tissue)),
        gateway_(std::move(cell), observer(), tissue_.get()) {}

  Result<SimulationResult> run(const SimulationProgress& progress) {
    const auto begin = std::chrono::steady_clock::now();
    const double processor_begin_s = processor_time_s();
    std::error_code error;
    if (auto begun = gateway_.begin(options_.script, std::filesystem::exists(options_.script, error)); !begun)
      return std::unexpected(begun.error());
    go_on(progress);
    result_.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    result_.processor_s = processor_time_s() - processor_begin_s;
    finish();
    return std::move(result_);
  }

 private:
  OffLineObserver observer() {
    OffLineObserver observer;
    observer.tick = [this](const std::shared_ptr<const CellState>& cell_state, const engine::TickState& tick) {
      motion_.observe(cell_state, tick);
      if (options_.collisions) collisions_.observe(cell_state, tick);
      if (tissue_) tissue_->observe(*cell_state, tick);
    };
    observer.move = [this](std::string_view robot, const motion::Move& move) { motion_.given(robot, move); };
    observer.message = [this](const ShownText& message) { keep(message); };
    observer.refused = [this](const Diagnostics& findings) { refused(findings); };
    observer.program = [this](const program::ProgramEvent& event) {
      programs_.hear(event);
      if (event.kind == program::ProgramEvent::Kind::stopped && in_deadlock(event.robot))
        result_.deadlock_was_stopped = true;
      last_event_s_ = gateway_.time_s();
    };
    return observer;
  }

  void keep(const ShownText& message) {
    if (result_.messages.size() == kMostKeptMessages) {
      ++result_.more_messages;
      return;
    }
    result_.messages.push_back({seconds(message.time - OffLineGateway::kBegin), message.text});
  }

  void refused(const Diagnostics& findings) {
    for (const Diagnostic& diagnostic : findings.all()) {
      if (result_.refusals.size() == kMostKeptRefusals) {
        ++result_.more_refusals;
        continue;
      }
      result_.refusals.push_back({gateway_.time_s(), diagnostic});
    }
  }

  void go_on(const SimulationProgress& progress) {
    double next_progress = 0;
    for (;;) {
      const bool worked = gateway_.work();
      const double now = gateway_.time_s();
      if (gateway_.owner().quiet()) return;
      if (worked || gateway_.robots_move() || gateway_.owner().programs().controllers().waits_for_time())
        last_event_s_ = now;
      if (stands_still(now - last_event_s_)) {
        result_.end = SimulationEnd::stands_still;
        return;
      }
      if (now >= options_.longest_s) {
        result_.end = SimulationEnd::time_limit;
        return;
      }
      if (progress && now >= next_progress) {
        progress(now);
        next_progress = now + 1.0;
      }
      gateway_.tick();
    }
  }

  // A program of that robot waits in the deadlock that lasts now.
  [[nodiscard]] bool in_deadlock(std::string_view robot) {
    const auto& deadlock = gateway_.owner().programs().controllers().deadlock();
    return deadlock && std::ranges::any_of(deadlock->waiting, [&](const auto& one) { return one.robot == robot; });
  }

  [[nodiscard]] bool stands_still(double for_s) const {
    const bool deadlock = gateway_.owner().programs().controllers().deadlock().has_value();
    return for_s > options_.still_s || (deadlock && for_s > kStillInDeadlock);
  }

  void finish() {
    const double now = gateway_.time_s();
    const CellState& cell_state = gateway_.cell_state();
    result_.script = options_.script;
    result_.simulated_s = now;
    result_.tick_s = seconds(period_);
    result_.ticks = gateway_.ticks();
    result_.commands = cell_state.script.file.received;
    const std::vector<program::ProgramStatus> status = gateway_.owner().programs().controllers().status();
    programs_.finish(status, now, result_);
    motion_.finish(result_);
    collisions_.finish(result_.collision);
    if (tissue_) tissue_->finish(result_.tissue);
    if (!options_.collisions) result_.collision.why_not = "--no-collisions";
    if (result_.end != SimulationEnd::finished) result_.end_note = end_note(status);
  }

  // Who has not ended, where, and what could be done about it.
  [[nodiscard]] std::string end_note(const std::vector<program::ProgramStatus>& programs) const {
    std::string who;
    bool computes = false;
    for (const program::ProgramStatus& program : programs) {
      const std::string doing = what_it_does(program);
      if (doing.empty()) continue;
      computes = computes || program.state == program::ProgramState::running;
      who += fmt::format("{}{} of {} {}", who.empty() ? "" : "; ", program.name, program.robot, doing);
    }
    if (result_.end == SimulationEnd::time_limit) {
      if (who.empty() && gateway_.robots_move()) who = "a robot still moves";
      return fmt::format("{:g} s are over (--for){}{}{}", options_.longest_s, who.empty() ? "" : ": ", who,
                         computes ? "; does it end?" : "");
    }
    // A deadlock is reported separately, and lasts whatever the options say.
    if (gateway_.owner().programs().controllers().deadlock()) return who;
    return fmt::format("nothing has happened for {:g} s (--still){}{}", options_.still_s, who.empty() ? "" : ": ",
                       who.empty() ? "" : who + "; SET_INPUT and SET_ANALOG_INPUT in the script set inputs");
  }

  // Empty: it has ended, or never began.
  [[nodiscard]] static std::string what_it_does(const program::ProgramStatus& program) {
    const std::string at = program.step.empty() ? fmt::format("line {}", program.line) : program.step;
    if (!program.waits_for.empty()) return fmt::format("waits for {} at {}", program.waits_for, at);
    if (program.state == program::ProgramState::running) return fmt::format("still runs, at {}", at);
    if (program.state == program::ProgramState::held) return fmt::format("is held at {}", at);
    return {};
  }

  SimulationOptions options_;
  Nanoseconds period_;
  SimulationResult result_;
  double last_event_s_ = 0;  // when anything happened, moved or was about to by itself
  MotionRecorder motion_;
  ProgramRecorder programs_;
  CollisionWatch collisions_;
  std::unique_ptr<OffLineTissue> tissue_;
  OffLineGateway gateway_;
};

}  // namespace

bool SimulationResult::failed() const {
  const bool program_failed =
      std::ranges::any_of(programs, [](const SimulatedProgram& p) { return p.end == "failed"; });
  // A deadlock that nobody ends has the script stand still. Where a program that the script starts later releases what
  // was waited for, nothing was wrong; where a program had to be stopped, the cell does not work.
  return end != SimulationEnd::finished || !refusals.empty() || program_failed || deadlock_was_stopped;
}

Result<SimulationResult> simulate(LoadedCell cell, const SimulationOptions& options,
                                  const SimulationProgress& progress) {
  std::string name = cell.name;
  auto tissue = OffLineTissue::make(cell.tissue, OffLineGateway::kBegin);
  if (!tissue) return std::unexpected(tissue.error());
  const auto simulation = std::make_unique<Simulation>(std::move(cell), options, *std::move(tissue));
  auto result = simulation->run(progress);
  if (result) result->cell = std::move(name);
  return result;
}

}  // namespace cellmirror::app
