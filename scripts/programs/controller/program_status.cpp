#include "scripts/programs/controller/program_status.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

namespace cellmirror::program {

std::string_view name_of(ProgramState state) {
  constexpr std::array<std::string_view, 9> kNames = {"loaded", "queued", "delayed", "running", "waiting",
                                                      "held",   "ended",  "stopped", "failed"};
  return kNames[static_cast<std::size_t>(state)];
}

std::string_view name_of(ProgramEvent::Kind kind) {
  constexpr std::array<std::string_view, 10> kNames = {"started", "command", "done", "move_ended", "ended",
                                                       "stopped", "failed",  "held", "resumed",    "deadlock"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string Deadlock::text() const {
  std::string text = "deadlock: ";
  for (const Waiting& waiter : waiting) {
    if (&waiter != &waiting.front()) text += "; ";
    text +=
        fmt::format("{} {} waits at {} for semaphore {}", waiter.robot, waiter.program, waiter.step, waiter.semaphore);
    if (!waiter.releasers.empty()) text += fmt::format(", which {} could release", fmt::join(waiter.releasers, " or "));
    if (waiter.releasers.empty()) text += ", which no started program releases";
    if (!waiter.not_started.empty())
      text += fmt::format(" ({} could, if started)", fmt::join(waiter.not_started, ", "));
    for (const std::string& keeper : waiter.kept_by) text += fmt::format(", {} before it released it", keeper);
  }
  return text;
}

}  // namespace cellmirror::program
