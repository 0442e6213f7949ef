// Parts of the published state of a robot (transfer_part(), rt_core/engine/state_transfer.hpp) for people. Pure.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "rt_core/engine/tick_state.hpp"
#include "rt_core/ports/haptic_state.hpp"

namespace cellmirror::app {

// "position", "motion", ...
[[nodiscard]] std::string_view part_name(std::size_t part);
// All digits of a number. Of values of joints that of `joint`.
[[nodiscard]] std::string part_text(const engine::RobotTickState& state, std::size_t part, std::size_t joint);
[[nodiscard]] std::string haptic_text(const HapticState& state);

}  // namespace cellmirror::app
