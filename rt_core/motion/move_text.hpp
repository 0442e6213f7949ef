// Moves as text: the trace that scripts and robot programs are compared by. Real-time class: worker threads.
#pragma once

#include <cstddef>
#include <string>

#include "rt_core/motion/move.hpp"

namespace cellmirror::motion {

// One line without its end: everything that decides how the robot moves, in SI (m, rad, s), six digits after the point,
// never "-0.000000"; poses as x y z qx qy qz qw with qw >= 0. The same move always gives the same text.
[[nodiscard]] std::string move_text(const Move& move, std::size_t joints);

}  // namespace cellmirror::motion
