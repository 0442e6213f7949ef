// Reads the light barriers of the running cell and the ultrasonic sensors that are switched on, in a thread of its own:
// every tick, or as often as it can.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/snapshot/cell_poser.hpp"
#include "app/snapshot/object_pool.hpp"
#include "app/snapshot/proximity_board.hpp"
#include "app/snapshot/range_readings.hpp"
#include "app/snapshot/range_report.hpp"
#include "app/workers/result_age.hpp"
#include "app/workers/tick_worker.hpp"
#include "rt_core/engine/tick_reader.hpp"
#include "rt_core/geometry/solid.hpp"
#include "rt_core/ports/light_barrier.hpp"
#include "rt_core/ranging/range_finder.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

class RangingWorker final : private TickJob {
 public:
  // All but `solids` are not owned and outlive the worker.
  RangingWorker(engine::TickReader& ticks, const Board<CellState>& cell_states, const Clock& clock,
                Nanoseconds tick_period, std::shared_ptr<geometry::SolidLibrary> solids,
                std::vector<LightBarrier> barriers = {});

  // Any thread.
  [[nodiscard]] RangeReport report() const;
  [[nodiscard]] const Board<RangeReadings>& board() const { return board_; }

 private:
  bool wanted(const CellState& cell_state) override;
  void run(const CellState& cell_state, const engine::TickState& tick) override;
  void show_nothing();

  const Clock& clock_;
  const bool has_barriers_;

  // The worker's own.
  ranging::RangeFinder finder_;
  CellPoser follower_{true};
  std::uint64_t sequence_ = 0;
  ObjectPool<RangeReadings> recycled_;

  Board<RangeReadings> board_;
  ResultAge ages_;
  LatencyHistogram compute_;

  TickWorker worker_;  // last: it uses everything above
};

}  // namespace cellmirror::app
