// Gives the I/O nodes their inputs, every tick.
#pragma once

#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/range_readings.hpp"
#include "app/workers/tick_worker.hpp"
#include "rt_core/engine/tick_reader.hpp"

namespace cellmirror::app {

class IoWorker final : private TickJob {
 public:
  // All are not owned and outlive the worker.
  IoWorker(engine::TickReader& ticks, const Board<CellState>& cell_states, const Board<RangeReadings>& ranges,
           const Clock& clock, Nanoseconds tick_period);

 private:
  bool wanted(const CellState& cell_state) override { return !cell_state.io_nodes.empty(); }
  void run(const CellState& cell_state, const engine::TickState& tick) override;

  const Board<RangeReadings>& ranges_;
  TickWorker worker_;  // last: it uses everything above
};

}  // namespace cellmirror::app
