#include "scripts/programs/irdata/jumps.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rt_core/base/text.hpp"

namespace cellmirror::program::irdata {

std::uint32_t Jumps::new_block(std::uint32_t within) {
  outer_blocks_.push_back(within);
  return static_cast<std::uint32_t>(outer_blocks_.size() - 1);
}

void Jumps::begin_record(std::uint32_t number, const Spot& spot) {
  Record record{number, {}, spot};
  const auto wanted = record_targets_.empty() ? record_targets_.end() : record_targets_.find(number);
  if (wanted != record_targets_.end()) {
    record.label = targets_[wanted->second].label;
    targets_[wanted->second].spot = spot;
  } else {
    record.label = builder_.new_label();
  }
  builder_.bind(record.label);
  records_.push_back(record);
}

std::uint32_t Jumps::target_index(std::unordered_map<std::string_view, std::uint32_t>& names, std::string_view name,
                                  Kind kind) {
  const auto [entry, is_new] = names.try_emplace(name, static_cast<std::uint32_t>(targets_.size()));
  if (is_new) targets_.push_back({builder_.new_label(), kind, name, 0, {}});
  return entry->second;
}

void Jumps::define(Target& target, const Spot& spot, std::string_view what) {
  if (target.spot.line != 0) {
    findings_.error(spot.column, fmt::format("{} '{}' exists already, in line {}", what, target.name, target.spot.line),
                    "give it another name");
    return;
  }
  target.spot = spot;
  builder_.bind(target.label);
}

void Jumps::define_label(std::string_view name, const Spot& spot) {
  define(targets_[target_index(labels_, name, Kind::label)], spot, "label");
}

void Jumps::define_subprogram(std::string_view name, const Spot& spot) {
  define(targets_[target_index(subprograms_, name, Kind::subprogram)], spot, "subprogram");
}

ProgramBuilder::Label Jumps::use(std::uint32_t target, const Spot& from) {
  uses_.push_back({target, from});
  return targets_[target].label;
}

ProgramBuilder::Label Jumps::to_label(std::string_view name, const Spot& from) {
  return use(target_index(labels_, name, Kind::label), from);
}

ProgramBuilder::Label Jumps::to_subprogram(std::string_view name, const Spot& from) {
  return use(target_index(subprograms_, name, Kind::subprogram), from);
}

ProgramBuilder::Label Jumps::to_record(std::uint32_t number, const Spot& from) {
  const auto [entry, is_new] = record_targets_.try_emplace(number, static_cast<std::uint32_t>(targets_.size()));
  if (is_new) {
    const auto record = std::ranges::lower_bound(records_, number, {}, &Record::number);
    const bool known = record != records_.end() && record->number == number;
    targets_.push_back(
        {known ? record->label : builder_.new_label(), Kind::record, {}, number, known ? record->spot : Spot{}});
  }
  return use(entry->second, from);
}

bool Jumps::encloses(std::uint32_t outer, std::uint32_t block) const {
  // Nested blocks have greater numbers, and the nesting is bounded.
  while (block > outer) block = outer_blocks_[block];
  return block == outer;
}

std::string Jumps::name_of_target(const Target& target) const {
  if (target.kind == Kind::record) return fmt::format("record {}", target.number);
  return fmt::format("{} '{}'", target.kind == Kind::label ? "label" : "subprogram", printable(target.name, 40));
}

std::string Jumps::remedy_for(const Target& target) {
  constexpr std::size_t kMostNames = 1000;
  if (target.kind != Kind::record && findings_.may_suggest()) {
    std::vector<std::string> names;
    for (const Target& other : targets_)
      if (other.kind == target.kind && other.spot.line != 0 && names.size() < kMostNames)
        names.emplace_back(other.name);
    const std::string near = did_you_mean(target.name, names);
    if (!near.empty()) return near;
  }
  if (target.kind == Kind::label)
    return fmt::format("put a record 'LABEL, {}' at the target of the jump", printable(target.name, 40));
  if (target.kind == Kind::subprogram)
    return fmt::format("put a record 'SUBPROGRAM, {}' after END", printable(target.name, 40));
  return "write the number of a record of this program";
}

void Jumps::check(const Use& use) {
  const Target& target = targets_[use.target];
  const Spot& from = use.from;
  if (target.spot.line == 0) {
    findings_.error_at(from.line, from.column, fmt::format("there is no {}", name_of_target(target)),
                       remedy_for(target));
  } else if (target.kind == Kind::subprogram) {
    return;
  } else if (target.spot.scope != from.scope) {
    findings_.error_at(from.line, from.column,
                       fmt::format("{} (line {}) is outside this {}", name_of_target(target), target.spot.line,
                                   from.scope == 0 ? "section: it is in a subprogram" : "subprogram"),
                       "jump within one section; enter and leave subprograms by CALL and RETURN");
  } else if (!encloses(target.spot.block, from.block)) {
    findings_.error_at(from.line, from.column,
                       fmt::format("{} (line {}) is within a block that does not contain this jump",
                                   name_of_target(target), target.spot.line),
                       "jump to the beginning of the block, or out of blocks only");
  }
}

void Jumps::finish() {
  for (const Use& use : uses_) check(use);
  for (const Target& target : targets_)
    if (!builder_.bound(target.label)) builder_.bind(target.label);  // reported above
}

}  // namespace cellmirror::program::irdata
