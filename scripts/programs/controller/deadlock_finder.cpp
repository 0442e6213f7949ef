#include "scripts/programs/controller/deadlock_finder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace cellmirror::program {

namespace {

// All waiting programs count as stuck first; then those are removed whose semaphore a program that is not stuck
// releases, until nothing changes.
std::vector<bool> stuck_ones(std::span<const WaitingProgram> programs) {
  std::vector<bool> stuck(programs.size());
  for (std::size_t i = 0; i < programs.size(); ++i) stuck[i] = !programs[i].semaphore.empty();
  const auto is_stuck = [&](const WaitingProgram& program) {
    return stuck[program.behind == WaitingProgram::kNone ? static_cast<std::size_t>(&program - programs.data())
                                                         : program.behind];
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < programs.size(); ++i) {
      if (!stuck[i] || programs[i].behind != WaitingProgram::kNone) continue;
      const bool freed = std::any_of(programs.begin(), programs.end(), [&](const WaitingProgram& program) {
        return !is_stuck(program) && program.program->releases(programs[i].semaphore);
      });
      if (freed) {
        stuck[i] = false;
        changed = true;
      }
    }
  }
  return stuck;
}

}  // namespace

std::optional<Deadlock> find_deadlock(std::span<const WaitingProgram> programs) {
  const std::vector<bool> stuck = stuck_ones(programs);
  Deadlock deadlock;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    if (!stuck[i]) continue;
    const WaitingProgram& program = programs[i];
    Deadlock::Waiting waiting{program.robot, program.program->name, program.step, program.semaphore, {}, {}, {}};
    for (const WaitingProgram& other : programs) {
      if (&other == &program || !other.program->releases(program.semaphore)) continue;
      waiting.releasers.push_back(fmt::format("{} {}", other.robot, other.program->name));
    }
    deadlock.waiting.push_back(std::move(waiting));
  }
  if (deadlock.waiting.empty()) return {};
  return deadlock;
}

}  // namespace cellmirror::program
