// All robot languages.
#pragma once

#include <span>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "scripts/programs/program/language.hpp"

namespace cellmirror::program {

// In the order in which people are shown them; irdata, the default of the manual, first.
[[nodiscard]] std::span<const Language> languages();
// By name, without regard to case. Refused with the names there are.
[[nodiscard]] Result<const Language*> find_language(std::string_view name);
// By the extension of a file (".ird"); null where none or several have it.
[[nodiscard]] const Language* language_of_extension(std::string_view extension);

}  // namespace cellmirror::program
