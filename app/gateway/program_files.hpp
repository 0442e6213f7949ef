// Robot programs in the home of a cell: finds and reads them.
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/base/result.hpp"
#include "scripts/programs/program/language.hpp"
#include "scripts/programs/program/program.hpp"

namespace cellmirror::app {

inline constexpr std::string_view kProgramFolder = "programs";

// The file that TF_LOAD means by `name`: in programs/, then in scripts/, as it stands and with each extension of the
// language. Refused with the places where it was looked for.
[[nodiscard]] Result<std::filesystem::path> find_program_file(const KismetHome& home, const program::Language& language,
                                                              std::string_view name);

// Reads and parses it; a table of codes of the user's (Language::codes_file) is looked for in the same folders. All
// findings are in `diagnostics`; a program with errors is refused with the first of them and their number.
[[nodiscard]] Result<std::shared_ptr<const program::Program>> read_program(const KismetHome& home,
                                                                           const program::Language& language,
                                                                           std::string_view name,
                                                                           Diagnostics& diagnostics);

}  // namespace cellmirror::app
