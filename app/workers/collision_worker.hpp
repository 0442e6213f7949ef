// Looks for collisions and distances in the running cell, in a thread of its own: every tick, or as often as it can.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "app/snapshot/cell_poser.hpp"
#include "app/snapshot/collision_report.hpp"
#include "app/snapshot/object_pool.hpp"
#include "app/snapshot/proximity_board.hpp"
#include "app/workers/result_age.hpp"
#include "app/workers/tick_worker.hpp"
#include "rt_core/collision/checker.hpp"
#include "rt_core/collision/mechanism.hpp"
#include "rt_core/collision/pairs.hpp"
#include "rt_core/engine/tick_reader.hpp"
#include "rt_core/geometry/solid.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

class CollisionWorker final : private TickJob {
 public:
  // All but `solids` are not owned and outlive the worker.
  CollisionWorker(engine::TickReader& ticks, const Board<CellState>& cell_states, const Clock& clock,
                  Nanoseconds tick_period, std::shared_ptr<geometry::SolidLibrary> solids);

  // Any thread.
  [[nodiscard]] CollisionReport report() const;
  [[nodiscard]] const ProximityBoard& board() const { return board_; }

 private:
  bool wanted(const CellState& cell_state) override;
  void run(const CellState& cell_state, const engine::TickState& tick) override;
  void show_nothing(const CellState& cell_state);
  // Derives the pairs again; up to a second for kinds of robots that were not seen before.
  void adopt(const CellState& cell_state);
  void check(const CellState& cell_state, const engine::TickState& tick);

  const Board<CellState>& cell_states_;
  const Clock& clock_;

  // The worker's own.
  collision::PairDerivation derivation_;
  collision::Checker checker_;
  CellPoser follower_{false};
  collision::RangeWatch ranges_;  // cleared with each new cell
  std::shared_ptr<const collision::Settings> settings_;
  bool nothing_to_test_ = false;
  ObjectPool<ProximityState> states_;
  std::uint64_t sequence_ = 0;

  ProximityBoard board_;
  ResultAge ages_;
  LatencyHistogram compute_;
  mutable std::mutex mutex_;  // of what follows
  std::shared_ptr<const collision::PairTable> pairs_;
  collision::CheckCounters counters_;
  std::string note_ = "pairs are being derived";

  TickWorker worker_;  // last: it uses everything above
};

}  // namespace cellmirror::app
