// When the controllers report a deadlock.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scripts/programs/controller/controllers.hpp"
#include "scripts/programs/controller/deadlock_finder.hpp"
#include "scripts/programs/controller/virtual_controller.hpp"

namespace cellmirror::program {

namespace {

void append_waiting(const VirtualController& controller, const Semaphores& semaphores,
                    std::vector<WaitingProgram>& programs) {
  std::size_t behind = WaitingProgram::kNone;
  if (const ProgramRun* run = controller.run(); run != nullptr) {
    behind = programs.size();
    // Held or not: it needs the semaphore first. With a free one it needs only to be resumed.
    const std::string wanted(semaphores.available(run->semaphore()) ? std::string_view{} : run->semaphore());
    programs.push_back({controller.robot(), &run->loaded(), run->step_name(), wanted, WaitingProgram::kNone});
  }
  for (const VirtualController::Queued& queued : controller.queue()) {
    programs.push_back({controller.robot(), queued.program.get(), {}, {}, behind});
  }
}

}  // namespace

void Controllers::search_deadlock() {
  const bool waiting = std::any_of(robots_.begin(), robots_.end(), [](const auto& robot) {
    return robot.second->run() != nullptr && !robot.second->run()->semaphore().empty();
  });
  std::optional<Deadlock> found;
  if (waiting) {
    std::vector<WaitingProgram> programs;
    for (const auto& [robot, controller] : robots_) append_waiting(*controller, context_.semaphores, programs);
    found = find_deadlock(programs);
  }
  const bool alone = found && std::any_of(found->waiting.begin(), found->waiting.end(),
                                          [](const Deadlock::Waiting& one) { return one.releasers.empty(); });
  if (!alone) alone_since_ = {};
  if (alone && !alone_since_.known()) alone_since_ = context_.clock.now();
  if (found) {
    for (Deadlock::Waiting& one : found->waiting) {
      one.not_started = could_release(one.semaphore);
      one.kept_by = context_.semaphores.kept_by(one.semaphore);
    }
  }
  if (deadlock_ == found) return;
  deadlock_.reset();
  const bool grace = alone && context_.clock.now() - alone_since_ < kGrace;
  if (found && !grace) report(std::move(*found));
}

// After a command: at once, since a script may ask for the deadlock before the next follow().
void Controllers::recheck_deadlock() {
  changed_ = true;
  if (!following_) search_deadlock();
}

std::vector<std::string> Controllers::could_release(std::string_view semaphore) const {
  std::vector<std::string> names;
  for (const auto& [robot, controller] : robots_) {
    for (const auto& [name, program] : controller->programs()) {
      if (!controller->occupied(*program) && program->releases(semaphore)) {
        names.push_back(fmt::format("{} {}", robot, name));
      }
    }
  }
  return names;
}

void Controllers::report(Deadlock found) {
  deadlock_ = std::move(found);
  ++context_.failures;
  context_.last_failure = deadlock_->text();
  const Deadlock::Waiting& first = deadlock_->waiting.front();
  if (context_.event) {
    context_.event(
        {ProgramEvent::Kind::deadlock, context_.clock.now(), first.robot, first.program, context_.last_failure, 0, 0});
  }
}

}  // namespace cellmirror::program
