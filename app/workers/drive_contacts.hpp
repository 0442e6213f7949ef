// Publishes what robots touch for their drives, which answer a controller. The collision worker's thread.
#pragma once

#include "app/snapshot/cell_state.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/collision/pairs.hpp"
#include "rt_core/ports/proximity_state.hpp"

namespace cellmirror::app {

// Of one computation; `cell`, `poses` and `table` are those that it was made with.
void report_contacts(const CellState& cell_state, const CompiledCell& cell, const CellPoses& poses,
                     const collision::PairTable& table, const ProximityState& found);
// That they touch nothing.
void clear_contacts(const CellState& cell_state);

}  // namespace cellmirror::app
