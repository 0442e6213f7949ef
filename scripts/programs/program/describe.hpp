// Expressions as text, for people: what a program waits for.
#pragma once

#include <string>

#include "scripts/programs/program/program.hpp"

namespace cellmirror::program {

// "input 3", "not input 3", "(A + 1) > 5"; variables by their names, numbers in the program's own units. Cut where it
// grows long.
[[nodiscard]] std::string describe(const Program& program, ExpressionId id);

}  // namespace cellmirror::program
