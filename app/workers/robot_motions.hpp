// The motions of the robots of a cell at one tick, as the computation of forces takes them.
#pragma once

#include <vector>

#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/dynamics/force_computation.hpp"
#include "rt_core/engine/tick_state.hpp"

namespace cellmirror::app {

// In the order of the robots of the cell. False, with `motions` undefined, where the tick does not have all of them
// yet: a component was just loaded. Any thread; allocates where `motions` is too small.
[[nodiscard]] bool read_motions(const CompiledCell& cell, const engine::TickState& tick,
                                std::vector<dynamics::RobotMotion>& motions);

}  // namespace cellmirror::app
