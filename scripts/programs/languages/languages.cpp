#include "scripts/programs/languages/languages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "rt_core/base/text.hpp"
#include "scripts/programs/crcl/crcl.hpp"
#include "scripts/programs/irdata/irdata.hpp"
#include "scripts/programs/jet/jet.hpp"
#include "scripts/programs/rapid/rapid.hpp"
#include "scripts/programs/srcl/srcl.hpp"

namespace cellmirror::program {

std::span<const Language> languages() {
  static const std::vector<Language> all = {
      irdata_language(), srcl_language(), jet_boom_language(), jet_tarm_language(), crcl_language(), rapid_language(),
  };
  return all;
}

Result<const Language*> find_language(std::string_view name) {
  std::string names;
  for (const Language& language : languages()) {
    if (equal_ignoring_case(language.name, name)) return &language;
    names += names.empty() ? "" : ", ";
    names += language.name;
  }
  return fail(fmt::format("there is no robot language '{}'", printable(name)), "one of: " + names);
}

const Language* language_of_extension(std::string_view extension) {
  const Language* found = nullptr;
  for (const Language& language : languages()) {
    const bool has = std::any_of(language.extensions.begin(), language.extensions.end(),
                                 [&](std::string_view one) { return equal_ignoring_case(one, extension); });
    if (!has) continue;
    if (found != nullptr) return nullptr;
    found = &language;
  }
  return found;
}

}  // namespace cellmirror::program
