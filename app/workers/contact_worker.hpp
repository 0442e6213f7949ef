// Finds the surroundings of the instruments of haptic devices, in a thread of its own: every tick, or as often as half
// of a processor allows. The tick evaluates what was found last.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "app/snapshot/cell_poser.hpp"
#include "app/snapshot/contact_report.hpp"
#include "app/workers/result_age.hpp"
#include "app/workers/tick_worker.hpp"
#include "rt_core/collision/mechanism.hpp"
#include "rt_core/collision/pairs.hpp"
#include "rt_core/contact_model/contact_finder.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/geometry/solid.hpp"
#include "rt_core/haptics/contact_model.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

class ContactWorker final : private TickJob {
 public:
  // All but `solids` are not owned and outlive the worker.
  ContactWorker(engine::Engine& engine, engine::TickReader& ticks, const Board<CellState>& cell_states,
                const Clock& clock, Nanoseconds tick_period, std::shared_ptr<geometry::SolidLibrary> solids);

  // Any thread.
  [[nodiscard]] ContactReport report() const;

 private:
  struct Finder {
    std::uint8_t slot = 0;
    double reach_m = 0;
    std::unique_ptr<contact_model::ContactFinder> finder;
    haptics::ContactModel found;
  };

  bool wanted(const CellState& cell_state) override;
  void run(const CellState& cell_state, const engine::TickState& tick) override;
  // True where the finders have adopted something new.
  bool follow(const CellState& cell_state);
  Finder& finder_for(const HapticSnapshot& haptic);

  engine::Engine& engine_;
  const Clock& clock_;

  // The worker's own.
  collision::PairDerivation derivation_;
  CellPoser follower_{false, true};  // planes are given at the tool centre point
  collision::RangeWatch ranges_;     // cleared when the bodies change
  bool ranges_news_ = false;         // true: a robot has left its ranges, and the pairs are out of date
  std::shared_ptr<const collision::Settings> settings_;
  std::shared_ptr<const collision::PairTable> pairs_;
  std::array<Finder, kMaxHapticDevices> finders_;
  std::uint64_t cells_ = 0;  // that were adopted

  ResultAge ages_;
  LatencyHistogram compute_;
  LatencyHistogram adopting_;
  mutable std::mutex mutex_;  // of what follows
  std::array<haptics::ContactModel, kMaxHapticDevices> newest_;

  TickWorker worker_;  // last: it uses everything above
};

}  // namespace cellmirror::app
