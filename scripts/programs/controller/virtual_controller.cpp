#include "scripts/programs/controller/virtual_controller.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::program {

Result<std::shared_ptr<LoadedProgram>> VirtualController::find(std::string_view name) const {
  if (const auto found = programs_.find(name); found != programs_.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [known, program] : programs_) names.push_back(known);
  const std::string alike = did_you_mean(name, names);
  return fail(fmt::format("{} is not loaded for {}", name, robot_),
              alike.empty() ? fmt::format("TF_LOAD {} {}", name, robot_) : alike);
}

Error VirtualController::none_runs() const {
  return {fmt::format("no program of {} runs", robot_), "start one with TF_RUN"};
}

bool VirtualController::occupied(const LoadedProgram& program) const {
  return (run_ && &run_->loaded() == &program) || std::any_of(queue_.begin(), queue_.end(), [&](const Queued& queued) {
           return queued.program.get() == &program;
         });
}

Result<void> VirtualController::check_load(std::string_view name, const Program& program) const {
  if (const auto known = programs_.find(name); known != programs_.end()) {
    if (occupied(*known->second)) {
      return fail(fmt::format("{} of {} runs or is queued", name, robot_), fmt::format("TF_STOP {}", robot_));
    }
  } else if (programs_.size() == kMostPrograms) {
    return fail(fmt::format("{} has {} programs already", robot_, kMostPrograms),
                "TF_DELETE those that are not needed");
  }
  Diagnostics findings;
  program.check_for(context_.motion.joint_kinds(robot_), findings);
  if (findings.ok()) return {};
  return fail(fmt::format("{} does not fit {}: {}", name, robot_, findings.all().front().text()));
}

void VirtualController::put(std::string_view name, std::shared_ptr<const Program> program) {
  programs_.insert_or_assign(std::string(name), std::make_shared<LoadedProgram>(std::string(name), std::move(program)));
}

Result<std::shared_ptr<LoadedProgram>> VirtualController::remove(std::string_view name) {
  auto found = find(name);
  if (!found) return found;
  if (occupied(**found)) {
    return fail(fmt::format("{} of {} runs or is queued", name, robot_), fmt::format("TF_STOP {}", robot_));
  }
  programs_.erase((*found)->name);
  return found;
}

Result<void> VirtualController::run(std::string_view name, bool exec_wait, Direction direction) {
  auto found = find(name);
  if (!found) return std::unexpected(std::move(found.error()));
  if (occupied(**found)) {
    return fail(fmt::format("{} of {} runs or is queued already", name, robot_),
                fmt::format("wait for its end, or TF_STOP {}", robot_));
  }
  if (direction == Direction::backward && !(*found)->program->reversible) {
    return fail(fmt::format("{} cannot run backward: only programs of check points can", name),
                "use a jet_boom or jet_tarm file");
  }
  if (auto free = context_.motion.check(robot_); !free) return free;
  if (!run_ && queue_.empty()) {
    begin({std::move(*found), direction}, context_.instant());
    return {};
  }
  if (!exec_wait) {
    return fail(fmt::format("{} runs {} already", robot_, run_ ? run_->loaded().name : queue_.front().program->name),
                fmt::format("queue it with TF_RUN {} {} exec_wait, or end the running one with TF_STOP {}", name,
                            robot_, robot_));
  }
  if (queue_.size() == kMostQueued) {
    return fail(fmt::format("{} programs are queued for {} already", kMostQueued, robot_),
                "wait until some have ended");
  }
  LoadedProgram& program = **found;
  program.state = ProgramState::queued;
  program.direction = direction;
  program.error.clear();
  program.step.clear();
  program.line = 0;
  program.elapsed_s = 0;
  queue_.push_back({std::move(*found), direction});
  return {};
}

void VirtualController::begin(const Queued& what, Timestamp when) {
  run_ = std::make_shared<ProgramRun>(context_, robot_, signals_, what.program, what.direction, when);
}

Result<void> VirtualController::hold() {
  if (!run_) return std::unexpected(none_runs());
  return run_->hold();
}

Result<void> VirtualController::resume() {
  if (!run_) return std::unexpected(none_runs());
  return run_->resume();
}

Result<void> VirtualController::step(Direction direction) {
  if (!run_) return std::unexpected(none_runs());
  return run_->step(direction);
}

Result<void> VirtualController::stop() {
  if (!busy()) return std::unexpected(none_runs());
  if (const std::shared_ptr<ProgramRun> run = std::exchange(run_, nullptr)) run->stop();
  drop_queue(ProgramState::stopped, {});
  return {};
}

void VirtualController::cancel(const std::string& why) {
  if (run_) {
    const std::shared_ptr<ProgramRun> run = std::exchange(run_, nullptr);
    run->fail_now(why);
    note_failure(run->loaded());
  }
  drop_queue(ProgramState::failed, why);
}

void VirtualController::drop_queue(ProgramState state, const std::string& why) {
  for (const Queued& queued : queue_) {
    queued.program->state = state;
    queued.program->error = why;
    if (!context_.event) continue;
    const auto kind = state == ProgramState::failed ? ProgramEvent::Kind::failed : ProgramEvent::Kind::stopped;
    context_.event({kind, context_.instant(), robot_, queued.program->name, why, 0, 0});
  }
  queue_.clear();
}

void VirtualController::begin_turn() {
  if (run_) run_->begin_turn();
}

bool VirtualController::follow() {
  bool any = false;
  while (run_) {
    const std::shared_ptr<ProgramRun> run = run_;
    if (run->end() == ProgramRun::End::none && run->follow()) any = true;
    if (run != run_) return true;  // a command of the program has ended it
    if (run->end() == ProgramRun::End::none) return any;
    end_run();
    any = true;
  }
  return any;
}

// Programs behind one that has failed rely on what it did not do: they do not start.
void VirtualController::end_run() {
  const std::shared_ptr<ProgramRun> run = std::exchange(run_, nullptr);
  if (run->end() == ProgramRun::End::ended) {
    begin_next(run->end_time());
    return;
  }
  if (run->end() != ProgramRun::End::failed) return;
  note_failure(run->loaded());
  if (!queue_.empty())
    drop_queue(ProgramState::failed,
               fmt::format("not started: the previous program {} has failed", run->loaded().name));
}

void VirtualController::begin_next(Timestamp when) {
  if (queue_.empty()) return;
  const Queued next = std::move(queue_.front());
  queue_.pop_front();
  if (auto free = context_.motion.check(robot_); !free) {
    queue_.push_front(next);
    drop_queue(ProgramState::failed, free.error().text());
    note_failure(*next.program);
    return;
  }
  begin(next, when);
}

void VirtualController::note_failure(const LoadedProgram& program) {
  ++context_.failures;
  context_.last_failure = fmt::format("program {} of {}: {}", program.name, robot_, program.error);
}

void VirtualController::append_status(std::vector<ProgramStatus>& statuses) const {
  for (const auto& [name, loaded] : programs_) {
    ProgramStatus status;
    status.robot = robot_;
    status.name = name;
    status.language = loaded->program->language;
    status.file = loaded->program->file;
    status.statements = loaded->program->statements.size();
    status.reversible = loaded->program->reversible;
    status.state = loaded->state;
    status.direction = loaded->direction;
    status.step = loaded->step;
    status.line = loaded->line;
    status.elapsed_s = loaded->elapsed_s;
    status.runs = loaded->runs;
    status.error = loaded->error;
    if (run_ && &run_->loaded() == loaded.get()) {
      status.state = run_->state();
      status.direction = run_->direction();
      status.waits_for = run_->waits_for();
      status.step = run_->step_name();
      status.line = run_->line();
      status.elapsed_s = run_->elapsed_s();
    }
    status.expected_s =
        loaded->direction == Direction::forward ? loaded->expected_forward_s : loaded->expected_backward_s;
    statuses.push_back(std::move(status));
  }
}

}  // namespace cellmirror::program
