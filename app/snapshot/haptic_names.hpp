// Phases and faults of haptic devices in words.
#pragma once

#include "rt_core/ports/haptic_state.hpp"

namespace cellmirror::app {

[[nodiscard]] const char* word(HapticPhase phase);  // as in status and docs/haptics.md
[[nodiscard]] const char* word(HapticFault fault);
// One sentence for people: what has happened.
[[nodiscard]] const char* explanation(HapticFault fault);
// And what to do, before RESET_HAPTIC.
[[nodiscard]] const char* remedy(HapticFault fault);

}  // namespace cellmirror::app
