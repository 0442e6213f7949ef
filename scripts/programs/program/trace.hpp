// Canonical commands as text: what programs are compared by, whatever their language.
#pragma once

#include <string>

#include "scripts/programs/program/canonical.hpp"

namespace cellmirror::program {

class Program;

// One line without its end: "LINE command details", SI with six digits after the point, never "-0.000000"; poses as x y
// z qx qy qz qw with qw >= 0; only what was set is told of the settings. The same command always gives the same text.
[[nodiscard]] std::string trace_line(const Program& program, const CanonicalCommand& command);

}  // namespace cellmirror::program
