// Robot programs of `cellmirror check`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/cell_file.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/cell/robot_model.hpp"
#include "scripts/lang/names.hpp"
#include "scripts/programs/program/language.hpp"

namespace cellmirror::app {

// For the command line.
[[nodiscard]] std::vector<std::string> language_names();
// ".ird .srcl ...": every extension that belongs to one language.
[[nodiscard]] std::string program_extensions();

// What a program is checked against; null: not.
struct ProgramSurroundings {
  const LoadedCell* cell = nullptr;
  const NameDirectory* names = nullptr;
  const RobotModel* robot = nullptr;
};

// All that is wrong with a program and with the SCRIPT commands in its comments; with `around` also what does not go
// with the cell and its robot. What could be read is checked where other parts are faulty. A table of codes of the user
// is looked for beside the file, as TF_LOAD does.
void check_robot_program(const std::filesystem::path& path, const program::Language& language,
                         const ProgramSurroundings& around, Diagnostics& diagnostics);

// Warns where the extension belongs to another language.
void check_language(const std::filesystem::path& path, const program::Language& language, Diagnostics& diagnostics);

}  // namespace cellmirror::app
