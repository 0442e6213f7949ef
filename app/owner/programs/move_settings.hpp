// What a program has set for a move, as robot parameters.
#pragma once

#include <span>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/robot_parameters.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "scripts/programs/program/canonical.hpp"

namespace cellmirror::app {

// The robot's parameters with the settings of `command` in their place: shares of rob_jnt_max_vel and rob_jnt_max_acc
// (of the planner's defaults where those are not set) instead of the active values; Cartesian speeds instead of the
// scaled ones, which stay the upper bounds; the fly point of the program, or of the robot where it has set none, and no
// fly point where the move does not fly. Refused: shares beyond (0, 1] and speeds that are not positive.
[[nodiscard]] Result<RobotParameters> parameters_for(const RobotParameters& robot, std::span<const JointKind> joints,
                                                     const program::MoveCommand& command);

}  // namespace cellmirror::app
