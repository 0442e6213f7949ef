#include "scripts/programs/controller/deadlock_finder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace cellmirror::program {

namespace {

// All waiting programs count as stuck first; then those are removed whose semaphore a program that is not stuck
// releases, until nothing changes.
std::vector<bool> stuck_ones(std::span<const Party> parties) {
  std::vector<bool> stuck(parties.size());
  for (std::size_t i = 0; i < parties.size(); ++i) stuck[i] = !parties[i].semaphore.empty();
  const auto is_stuck = [&](const Party& party) {
    return stuck[party.behind == Party::kNobody ? static_cast<std::size_t>(&party - parties.data()) : party.behind];
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < parties.size(); ++i) {
      if (!stuck[i] || parties[i].behind != Party::kNobody) continue;
      const bool freed = std::any_of(parties.begin(), parties.end(), [&](const Party& party) {
        return !is_stuck(party) && party.program->releases(parties[i].semaphore);
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

std::optional<Deadlock> find_deadlock(std::span<const Party> parties) {
  const std::vector<bool> stuck = stuck_ones(parties);
  Deadlock deadlock;
  for (std::size_t i = 0; i < parties.size(); ++i) {
    if (!stuck[i]) continue;
    const Party& party = parties[i];
    Deadlock::Waiting waiting{party.robot, party.program->name, party.step, party.semaphore, {}, {}, {}};
    for (const Party& other : parties) {
      if (&other == &party || !other.program->releases(party.semaphore)) continue;
      waiting.releasers.push_back(fmt::format("{} {}", other.robot, other.program->name));
    }
    deadlock.waiting.push_back(std::move(waiting));
  }
  if (deadlock.waiting.empty()) return {};
  return deadlock;
}

}  // namespace cellmirror::program
