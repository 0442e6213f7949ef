// What the inputs of an I/O node are at a moment.
#pragma once

#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/range_readings.hpp"
#include "rt_core/engine/tick_state.hpp"
#include "rt_core/ports/io_config.hpp"
#include "rt_core/ports/io_image.hpp"

namespace cellmirror::app {

// `ranges`: null where nothing was computed yet. A light barrier without a reading counts as interrupted, a sensor
// without one as without an echo, a robot that is not there as short of its limit switch. Any thread; no heap memory.
[[nodiscard]] IoInputs io_inputs(const IoNodeConfig& node, const CellState& cell_state, const engine::TickState& tick,
                                 const RangeReadings* ranges);

}  // namespace cellmirror::app
