#include "scripts/programs/rapid/names.hpp"

#include <algorithm>

#include "rt_core/base/text.hpp"

namespace cellmirror::program::rapid {

std::string_view word_of(Type type) {
  switch (type) {
    case Type::num:
      return "num";
    case Type::boolean:
      return "bool";
    case Type::robtarget:
      return "robtarget";
    case Type::jointtarget:
      return "jointtarget";
    case Type::speeddata:
      return "speeddata";
    case Type::signal_in:
      return "a digital input";
    case Type::signal_out:
      return "a digital output";
    case Type::unknown:
      break;
  }
  return "unknown";
}

ValueType value_type(Type type) {
  switch (type) {
    case Type::boolean:
      return ValueType::boolean;
    case Type::robtarget:
      return ValueType::pose;
    case Type::jointtarget:
      return ValueType::joints;
    default:
      return ValueType::real;
  }
}

const Declared* Names::find(std::string_view name) const {
  const std::string key = lower_case(name);
  // Bounded: loops nested deeper have been reported.
  constexpr std::size_t kMostLooked = 64;
  for (std::size_t depth = 1; depth <= std::min(kMostLooked, counters_.size()); ++depth) {
    const Counter& counter = counters_[counters_.size() - depth];
    if (counter.name == key) return &counter.declared;
  }
  if (const auto at = local_.find(key); at != local_.end()) return &at->second;
  const auto at = data_.find(key);
  return at == data_.end() ? nullptr : &at->second;
}

const Declared* Names::find_in_scope(std::string_view name) const {
  const auto& scope = in_procedure_ ? local_ : data_;
  const auto at = scope.find(lower_case(name));
  return at == scope.end() ? nullptr : &at->second;
}

bool Names::add(std::string_view name, const Declared& declared) {
  return (in_procedure_ ? local_ : data_).emplace(lower_case(name), declared).second;
}

void Names::forgive(std::string_view name) { local_.emplace(lower_case(name), Declared{}); }

void Names::end_procedure() {
  local_.clear();
  counters_.clear();
  in_procedure_ = false;
}

void Names::push_counter(std::string_view name, const Declared& counter) {
  counters_.push_back({lower_case(name), counter});
}

std::vector<std::string> Names::all() const {
  std::vector<std::string> names;
  names.reserve(size());
  for (const auto& [name, declared] : data_) names.push_back(name);
  for (const auto& [name, declared] : local_) names.push_back(name);
  for (const Counter& counter : counters_) names.push_back(counter.name);
  std::ranges::sort(names);
  return names;
}

}  // namespace cellmirror::program::rapid
