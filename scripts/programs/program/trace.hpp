// Canonical commands as text: what programs are compared by, whatever their language.
#pragma once

#include <string>

#include "scripts/programs/program/canonical.hpp"

namespace cellmirror::program {

class Program;

// One line without its end, "LINE COMMAND DETAILS". SI with six digits after the point, never "-0.000000"; poses as x y
// z qx qy qz qw with qw >= 0; only given settings are shown. The same command always gives the same text:
//   12 move ptp to joints 0.785398 -0.500000 with joint_velocity 0.500000
//   13 move circular via pose X to pose X fly with linear_velocity 0.250000 fly_distance 0.010000
//   14 move linear to pose+ X        relative in the axes of ZP; tool+: of the TCP; joints+: differences
//   15 delay 2.500000                s
//   16 tool X                        or "tool of the robot"
//   17 output 3 on                   output analogue 2 4.500000
//   18 wait input 3, at most 5.000000
//   19 acquire S1                    release S1, script TEXT, pause, rest
[[nodiscard]] std::string trace_line(const Program& program, const CanonicalCommand& command);

}  // namespace cellmirror::program
