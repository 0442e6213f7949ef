// Robot programs of `cellmirror check`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/cell/robot_model.hpp"
#include "scripts/programs/program/language.hpp"

namespace cellmirror::app {

// For the command line.
[[nodiscard]] std::vector<std::string> language_names();
// ".ird .srcl ...": every extension that belongs to one language.
[[nodiscard]] std::string program_extensions();

// All that is wrong with a program; with `robot` (may be null) also what does not fit its joints. A table of codes of
// the user is looked for beside the file, as TF_LOAD does.
void check_robot_program(const std::filesystem::path& path, const program::Language& language, const RobotModel* robot,
                         Diagnostics& diagnostics);

}  // namespace cellmirror::app
