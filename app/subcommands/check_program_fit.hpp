// What of a robot program does not go with the cell that it is for.
#pragma once

#include "app/subcommands/check_commands.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/cell/robot_model.hpp"
#include "scripts/programs/program/program.hpp"

namespace cellmirror::app {

// Its comments with SCRIPT commands: errors as in a SCRIPT file, and commands that programs may not use. With `cell`
// and `names`, which may both be null, also names, files and ranges.
void check_program_comments(const program::Program& program, const LoadedCell* cell, const NameDirectory* names,
                            Diagnostics& diagnostics);

// Moves to more joints than the robot has are errors; constant joint targets beyond its ranges are warnings; speeds and
// accelerations above its own, which bound them, are notes.
void check_program_fit(const program::Program& program, const RobotModel& robot, Diagnostics& diagnostics);

}  // namespace cellmirror::app
