#include "scripts/programs/jet/teach_names.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace cellmirror::program {

namespace {

constexpr std::size_t kLeastSlots = 64;

}  // namespace

int TeachNames::note(std::string_view name, int line) {
  if (2 * (entries_.size() + 1) > slots_.size()) grow();
  const auto hash = static_cast<std::uint32_t>(std::hash<std::string_view>{}(name));
  Slot& slot = find(hash, name);
  if (slot.entry != 0) return entries_[slot.entry - 1].line;
  entries_.push_back({name, line});
  slot = {hash, static_cast<std::uint32_t>(entries_.size())};
  return 0;
}

TeachNames::Slot& TeachNames::find(std::uint32_t hash, std::string_view name) {
  std::size_t at = hash & (slots_.size() - 1);
  // Names are compared only if the whole hash agrees: most searches touch one slot and nothing else.
  while (slots_[at].entry != 0 && (slots_[at].hash != hash || entries_[slots_[at].entry - 1].name != name))
    at = (at + 1) & (slots_.size() - 1);
  return slots_[at];
}

void TeachNames::grow() {
  std::vector<Slot> before(std::max(kLeastSlots, 4 * slots_.size()));
  std::swap(before, slots_);
  for (const Slot& slot : before)
    if (slot.entry != 0) find(slot.hash, entries_[slot.entry - 1].name) = slot;
}

}  // namespace cellmirror::program
