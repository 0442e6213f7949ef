#include "app/simulation/program_recorder.hpp"

#include <algorithm>

namespace cellmirror::app {

using program::ProgramEvent;

namespace {

constexpr std::size_t kMostDeadlocks = 100;

const char* end_word(ProgramEvent::Kind kind) {
  if (kind == ProgramEvent::Kind::failed) return "failed";
  return kind == ProgramEvent::Kind::stopped ? "stopped" : "ended";
}

}  // namespace

void ProgramRecorder::hear(const ProgramEvent& event) {
  const double now_s = seconds(event.time - begin_);
  keep(event, now_s);
  switch (event.kind) {
    case ProgramEvent::Kind::started:
      return begin(event, now_s);
    case ProgramEvent::Kind::command:
      return name_move(event);
    case ProgramEvent::Kind::ended:
    case ProgramEvent::Kind::stopped:
    case ProgramEvent::Kind::failed:
      return end(event, now_s);
    case ProgramEvent::Kind::deadlock:
      if (deadlocks_.size() < kMostDeadlocks) deadlocks_.push_back(event.text);
      return;
    case ProgramEvent::Kind::done:
    case ProgramEvent::Kind::move_ended:
    case ProgramEvent::Kind::held:
    case ProgramEvent::Kind::resumed:
      return;
  }
}

void ProgramRecorder::keep(const ProgramEvent& event, double now_s) {
  if (events_.size() == kMostKeptEvents) {
    ++more_events_;
    return;
  }
  events_.push_back({now_s, event.robot, event.program, std::string(name_of(event.kind)), event.line, event.text});
}

void ProgramRecorder::begin(const ProgramEvent& event, double now_s) {
  if (runs_.size() == kMostKeptRuns) {
    ++more_runs_;
    return;
  }
  running_[event.robot] = runs_.size();
  SimulatedProgram& run = runs_.emplace_back();
  run.robot = event.robot;
  run.name = event.program;
  run.begin_s = run.end_s = now_s;
}

void ProgramRecorder::end(const ProgramEvent& event, double now_s) {
  const auto known = running_.find(event.robot);
  // One that failed before it began: queued behind one that failed, or its robot is gone.
  const bool began = known != running_.end() && runs_[known->second].name == event.program;
  if (!began) begin(event, now_s);
  const auto running = running_.find(event.robot);
  if (running == running_.end() || runs_[running->second].name != event.program) return;
  SimulatedProgram& run = runs_[running->second];
  run.end_s = now_s;
  run.end = end_word(event.kind);
  if (event.kind == ProgramEvent::Kind::failed) run.error = event.text;
  running_.erase(running);
}

void ProgramRecorder::name_move(const ProgramEvent& event) {
  if (event.ticket == 0) return;
  if (SimulatedMove* move = moves_.find(event.robot, event.ticket)) {
    move->program = event.program;
    move->line = event.line;
  }
  const auto running = running_.find(event.robot);
  if (running != running_.end()) ++runs_[running->second].moves;
}

void ProgramRecorder::finish(const std::vector<program::ProgramStatus>& status, double now_s,
                             SimulationResult& result) {
  for (const auto& [robot, place] : running_) {
    SimulatedProgram& run = runs_[place];
    run.end_s = now_s;
    const auto now = std::ranges::find_if(
        status, [&](const program::ProgramStatus& s) { return s.robot == robot && s.name == run.name; });
    if (now == status.end()) continue;
    run.end = name_of(now->state);
    run.waits_for = now->waits_for;
  }
  result.programs = std::move(runs_);
  result.more_programs = more_runs_;
  result.deadlocks = std::move(deadlocks_);
  result.events = std::move(events_);
  result.more_events = more_events_;
}

}  // namespace cellmirror::app
