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

// What a file was read as.
struct ProgramText {
  Result<std::shared_ptr<const program::Program>> program;
  Diagnostics findings;
};

// Reads and parses the file at `path`; a table of codes of the user's (Language::codes_file) is looked for in the same
// folders. A program with errors is refused with the first of them and their number. Any thread.
[[nodiscard]] ProgramText read_program(const KismetHome& home, const program::Language& language,
                                       const std::filesystem::path& path);

}  // namespace cellmirror::app
