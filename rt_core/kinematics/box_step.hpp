// One damped step inside the box of the limits: the linear algebra of the search. Internal to the folder.
#pragma once

#include <array>
#include <cstddef>

#include "rt_core/base/real_time.hpp"
#include "rt_core/kinematics/chain.hpp"

namespace cellmirror::kinematics {

using Six = std::array<double, 6>;

// e: what is left of the task; column i: what one unit of variable i takes off it. All of it without units: lengths and
// sliding variables in units of one length, angles in rad.
struct Linearised {
  Six e{};
  std::array<Six, kMaxVariables> column{};
  std::size_t variables = 0;
};

// How far each variable may move; below is not positive, above is not negative.
struct Room {
  std::array<double, kMaxVariables> below{};
  std::array<double, kMaxVariables> above{};
};

// Writes the step of damped least squares, dq = J^T (J J^T + damping I)^-1 e, that stays within `room`: a variable that
// would leave it goes to its border and the step is solved again for the others (active set). J J^T is 6 x 6 whatever
// the number of variables. Returns the largest component.
double box_step(const Linearised& at, const Room& room, double damping, std::array<double, kMaxVariables>& dq) CELL_RT;

// The step that takes off e and otherwise comes nearest to `wished`: the least squared distance from it (as far as
// `damping` lets e be taken off).
double box_step_towards(const Linearised& at, const Room& room, double damping,
                        const std::array<double, kMaxVariables>& wished, std::array<double, kMaxVariables>& dq) CELL_RT;

}  // namespace cellmirror::kinematics
