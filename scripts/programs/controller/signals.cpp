#include "scripts/programs/controller/signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace cellmirror::program {

Result<Semaphores::Semaphore*> Semaphores::open(std::string_view name) {
  if (const auto found = semaphores_.find(name); found != semaphores_.end()) return &found->second;
  if (semaphores_.size() == kMost) {
    return fail(fmt::format("there are {} semaphores already", kMost), "TF_DELETE programs that are not needed");
  }
  return &semaphores_.emplace(std::string(name), Semaphore{}).first->second;
}

Result<void> Semaphores::declare(std::string_view name, std::uint32_t initial) {
  if (initial > kMostCount) {
    return fail(fmt::format("semaphore {} begins with {}; {} is the maximum", name, initial, kMostCount));
  }
  auto opened = open(name);
  if (!opened) return std::unexpected(std::move(opened.error()));
  Semaphore& semaphore = **opened;
  if (semaphore.declared && semaphore.initial != initial) {
    return fail(fmt::format("semaphore {} begins with {}, but another program has declared it with {}", name, initial,
                            semaphore.initial),
                "declare it with the same count everywhere");
  }
  if (!semaphore.declared) {
    semaphore.count = std::min(kMostCount, semaphore.count + initial);  // released before it was declared
    semaphore.initial = initial;
    semaphore.declared = true;
  }
  return {};
}

bool Semaphores::available(std::string_view name) const {
  const auto found = semaphores_.find(name);
  return found != semaphores_.end() && found->second.count > 0;
}

bool Semaphores::try_acquire(std::string_view name) {
  const auto found = semaphores_.find(name);
  if (found == semaphores_.end() || found->second.count == 0) return false;
  --found->second.count;
  return true;
}

Result<void> Semaphores::release(std::string_view name, Timestamp when) {
  auto opened = open(name);
  if (!opened) return std::unexpected(std::move(opened.error()));
  Semaphore& semaphore = **opened;
  if (semaphore.count == kMostCount) return fail(fmt::format("semaphore {} counts {} already", name, kMostCount));
  ++semaphore.count;
  semaphore.released = std::max(semaphore.released, when);
  return {};
}

Timestamp Semaphores::released(std::string_view name) const {
  const auto found = semaphores_.find(name);
  return found == semaphores_.end() ? Timestamp{} : found->second.released;
}

void Semaphores::keep(std::string_view name, std::string who) {
  const auto found = semaphores_.find(name);
  if (found == semaphores_.end()) return;
  std::vector<std::string>& kept_by = found->second.kept_by;
  if (std::ranges::find(kept_by, who) == kept_by.end()) kept_by.push_back(std::move(who));
}

void Semaphores::make_up(std::string_view name) {
  const auto found = semaphores_.find(name);
  if (found == semaphores_.end() || found->second.kept_by.empty()) return;
  found->second.kept_by.erase(found->second.kept_by.begin());
}

std::vector<std::string> Semaphores::kept_by(std::string_view name) const {
  const auto found = semaphores_.find(name);
  return found == semaphores_.end() ? std::vector<std::string>{} : found->second.kept_by;
}

void Semaphores::reset(std::string_view name) {
  const auto found = semaphores_.find(name);
  if (found == semaphores_.end()) return;
  found->second.count = found->second.initial;
  found->second.released = {};
  found->second.kept_by.clear();
}

void Semaphores::forget(std::string_view name) {
  if (const auto found = semaphores_.find(name); found != semaphores_.end()) semaphores_.erase(found);
}

std::map<std::string, std::uint32_t> Semaphores::counts() const {
  std::map<std::string, std::uint32_t> counts;
  for (const auto& [name, semaphore] : semaphores_) counts.emplace(name, semaphore.count);
  return counts;
}

}  // namespace cellmirror::program
