// Writes the force at the TCP of the active robot into the shared memory of key 1313, every tick.
#pragma once

#include <cstdint>

#include "app/snapshot/cell_state.hpp"
#include "app/workers/tick_worker.hpp"
#include "ipc/wire/tcp_force_block.hpp"
#include "rt_core/engine/tick_reader.hpp"
#include "rt_core/ports/instrument_load.hpp"

namespace cellmirror::app {

// Returns the force without its sequence. `loads`: of soft tissue on instruments; null: the cell has no tissue.
[[nodiscard]] TcpForce tcp_force_of(const CellState& cell_state, const engine::TickState& tick,
                                    const InstrumentLoads* loads = nullptr);

class TcpForceWorker final : private TickJob {
 public:
  // The arguments are not owned and outlive the worker. `loads`: of soft tissue on instruments; null: the cell has no
  // tissue.
  TcpForceWorker(engine::TickReader& ticks, const Board<CellState>& cell_states, const Clock& clock,
                 Nanoseconds tick_period, const Board<InstrumentLoads>* loads = nullptr);

 private:
  bool wanted(const CellState& cell_state) override { return cell_state.tcp_force != nullptr; }
  void run(const CellState& cell_state, const engine::TickState& tick) override;

  const Board<InstrumentLoads>* const loads_;
  std::uint64_t sequence_ = 0;
  TickWorker worker_;  // last: it uses everything above
};

}  // namespace cellmirror::app
