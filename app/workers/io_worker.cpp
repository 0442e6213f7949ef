#include "app/workers/io_worker.hpp"

#include <memory>

#include "app/workers/io_inputs.hpp"

namespace cellmirror::app {

IoWorker::IoWorker(engine::TickReader& ticks, const Board<CellState>& cell_states, const Board<RangeReadings>& ranges,
                   const Clock& clock, Nanoseconds tick_period)
    : ranges_(ranges), worker_(*this, ticks, cell_states, clock, tick_period) {}

void IoWorker::run(const CellState& cell_state, const engine::TickState& tick) {
  const std::shared_ptr<const RangeReadings> ranges = ranges_.latest();
  for (const IoNodeSnapshot& node : cell_state.io_nodes)
    node.inputs->write(io_inputs(*node.config, cell_state, tick, ranges.get()));
}

}  // namespace cellmirror::app
