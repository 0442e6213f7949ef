// Executes a program without a controller and writes down the canonical commands: the golden trace of every language.
#pragma once

#include <string>
#include <string_view>

#include "scripts/programs/program/machine.hpp"

namespace cellmirror::testing {

// The robot of the golden traces: R R R P R R.
std::span<const JointKind> golden_joints();

// `inputs`: text of inputs.txt. The trace, with how it ended; a reversible program is run backward as well.
// There is no kinematics: a joint target changes the joints only, a pose the TCP only, and moves arrive at once.
std::string golden_trace(const std::shared_ptr<const program::Program>& program, std::string_view inputs);

}  // namespace cellmirror::testing
