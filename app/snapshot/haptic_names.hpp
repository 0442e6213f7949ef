// Faults of haptic devices in sentences; their words are in rt_core/ports/words.hpp.
#pragma once

#include <string>
#include <string_view>

#include "rt_core/ports/haptic_state.hpp"

namespace cellmirror::app {

// One sentence for people: what has happened.
[[nodiscard]] const char* explanation(HapticFault fault);
// And what to do, before RESET_HAPTIC.
[[nodiscard]] const char* remedy(HapticFault fault);
// What a latched fault waits for, in words that follow "waits for"; empty without a fault.
[[nodiscard]] const char* explanation(HapticAwaited awaited);
// The fault of the device of `robot`, why, and what ends it: RESET_HAPTIC, or what it waits for. Empty without a fault.
[[nodiscard]] std::string fault_text(const HapticState& state, std::string_view robot);

}  // namespace cellmirror::app
