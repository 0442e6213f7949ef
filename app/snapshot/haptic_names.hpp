// Faults of haptic devices in sentences; their words are in rt_core/ports/words.hpp.
#pragma once

#include "rt_core/ports/haptic_state.hpp"

namespace cellmirror::app {

// One sentence for people: what has happened.
[[nodiscard]] const char* explanation(HapticFault fault);
// And what to do, before RESET_HAPTIC.
[[nodiscard]] const char* remedy(HapticFault fault);

}  // namespace cellmirror::app
