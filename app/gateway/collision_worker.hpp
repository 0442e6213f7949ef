// Looks for collisions and distances in the running cell, in a thread of its own: every tick, or as often as it can.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "app/gateway/age_keeper.hpp"
#include "app/gateway/cell_follower.hpp"
#include "app/gateway/findings_board.hpp"
#include "app/gateway/recycler.hpp"
#include "app/gateway/tick_worker.hpp"
#include "rt_core/collision/checker.hpp"
#include "rt_core/collision/pairs.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/geometry/solid.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

// All that status tells of it, as of one moment.
struct CollisionReport {
  static constexpr std::size_t kEvents = 32;

  bool active = false;
  double warning_distance_m = 0;
  std::string note;                                   // for people; empty: there is nothing special
  std::shared_ptr<const ProximityState> state;        // null: nothing was computed yet
  std::shared_ptr<const collision::PairTable> pairs;  // null: not derived yet
  collision::CheckCounters counters;
  std::vector<ProximityEvent> events;  // the newest, oldest first
  std::uint64_t skipped = 0;           // ticks for which nothing was computed because the computation took longer
  double rate_hz = 0;
  HistogramSnapshot age;  // at which results were replaced by newer ones: none was read at a greater age
  HistogramSnapshot visible_after;
  HistogramSnapshot compute;
};

class CollisionWorker final : private TickJob {
 public:
  // All but `solids` are not owned and outlive the worker.
  CollisionWorker(engine::Engine& engine, const PictureBoard& pictures, const Clock& clock, Nanoseconds tick_period,
                  std::shared_ptr<geometry::SolidLibrary> solids);

  // Any thread.
  [[nodiscard]] CollisionReport report() const;
  [[nodiscard]] const ProximityBoard& board() const { return board_; }

 private:
  bool wanted(const OwnerPicture& picture) override;
  void run(const OwnerPicture& picture, const engine::TickState& tick) override;
  void show_nothing(const OwnerPicture& picture);
  // Derives the pairs anew; up to a second for kinds of robots that were not seen before.
  void adopt(const OwnerPicture& picture);
  void check(const engine::TickState& tick);

  const PictureBoard& pictures_;
  const Clock& clock_;

  // The worker's own.
  collision::PairDerivation derivation_;
  collision::Checker checker_;
  CellFollower follower_{false};
  std::shared_ptr<const collision::Settings> settings_;
  bool nothing_to_test_ = false;
  Recycler<ProximityState> states_;
  std::uint64_t sequence_ = 0;

  ProximityBoard board_;
  AgeKeeper ages_;
  LatencyHistogram compute_;
  mutable std::mutex mutex_;  // of what follows
  std::shared_ptr<const collision::PairTable> pairs_;
  collision::CheckCounters counters_;
  std::string note_ = "pairs are being derived";

  TickWorker worker_;  // last: it uses everything above
};

}  // namespace cellmirror::app
