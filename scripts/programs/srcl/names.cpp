#include "scripts/programs/srcl/names.hpp"

#include <algorithm>

namespace cellmirror::program::srcl {

std::vector<std::string> Names::all() const {
  std::vector<std::string> names;
  names.reserve(declared_.size());
  for (const auto& [name, declared] : declared_) names.emplace_back(name);
  std::ranges::sort(names);
  return names;
}

}  // namespace cellmirror::program::srcl
