// Computes the forces of the running cell's robots, in a thread of its own: every tick, or as often as it can.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "app/snapshot/board.hpp"
#include "app/snapshot/force_report.hpp"
#include "app/snapshot/object_pool.hpp"
#include "app/workers/result_age.hpp"
#include "app/workers/tick_worker.hpp"
#include "rt_core/dynamics/force_computation.hpp"
#include "rt_core/engine/tick_reader.hpp"
#include "rt_core/ports/instrument_load.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

class ForceWorker final : private TickJob {
 public:
  // The arguments are not owned and outlive the worker, except gravity_W (m/s2, in the world). `loads`: of soft tissue
  // on instruments; null: the cell has no tissue.
  ForceWorker(engine::TickReader& ticks, const Board<CellState>& cell_states, const Clock& clock,
              Nanoseconds tick_period, const Eigen::Vector3d& gravity_W, const Board<InstrumentLoads>* loads = nullptr);

  // Any thread.
  [[nodiscard]] ForceReport report() const;
  [[nodiscard]] const Board<ForceState>& board() const { return board_; }

 private:
  bool wanted(const CellState& cell_state) override;
  void run(const CellState& cell_state, const engine::TickState& tick) override;
  void take_cell(const CellState& cell_state);
  void show_nothing();

  const Clock& clock_;
  const Eigen::Vector3d gravity_W_;
  const Board<InstrumentLoads>* const loads_;
  dynamics::ForceComputation computation_;  // the worker's own
  std::vector<dynamics::RobotMotion> motions_;
  ObjectPool<ForceState> states_;
  std::uint64_t sequence_ = 0;

  Board<ForceState> board_;
  ResultAge ages_;
  LatencyHistogram compute_;
  mutable std::mutex mutex_;  // of what follows
  bool active_ = false;
  std::vector<dynamics::NotComputed> not_computed_;
  std::uint64_t limit_warnings_ = 0;

  TickWorker worker_;  // last: it uses everything above
};

}  // namespace cellmirror::app
