// Reads the ultrasonic sensors of the running cell that are switched on, in a thread of its own: every tick, or as
// often as it can.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "app/gateway/age_keeper.hpp"
#include "app/gateway/cell_follower.hpp"
#include "app/gateway/findings_board.hpp"
#include "app/gateway/recycler.hpp"
#include "app/gateway/tick_worker.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/geometry/solid.hpp"
#include "rt_core/ranging/range_finder.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

// All that status tells of it, as of one moment.
struct RangeReport {
  std::shared_ptr<const RangeReadings> readings;  // null: nothing was computed yet
  std::uint64_t skipped = 0;
  double rate_hz = 0;
  HistogramSnapshot age;
  HistogramSnapshot compute;
};

class RangingWorker final : private TickJob {
 public:
  // All but `solids` are not owned and outlive the worker.
  RangingWorker(engine::Engine& engine, const PictureBoard& pictures, const Clock& clock, Nanoseconds tick_period,
                std::shared_ptr<geometry::SolidLibrary> solids);

  // Any thread.
  [[nodiscard]] RangeReport report() const;
  [[nodiscard]] const RangeBoard& board() const { return board_; }

 private:
  bool wanted(const OwnerPicture& picture) override;
  void run(const OwnerPicture& picture, const engine::TickState& tick) override;
  void show_nothing();

  const Clock& clock_;

  // The worker's own.
  ranging::RangeFinder finder_;
  CellFollower follower_{true};
  std::uint64_t sequence_ = 0;
  Recycler<RangeReadings> recycled_;

  RangeBoard board_;
  AgeKeeper ages_;
  LatencyHistogram compute_;

  TickWorker worker_;  // last: it uses everything above
};

}  // namespace cellmirror::app
