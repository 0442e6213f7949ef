// Collision tests of the off-line simulation: the code of the gateway's worker (CellPoser, PairDerivation, Checker),
// a test every so often of simulated time instead of as often as a thread can.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "app/simulation/simulation_result.hpp"
#include "app/snapshot/cell_poser.hpp"
#include "app/snapshot/cell_state.hpp"
#include "rt_core/collision/checker.hpp"
#include "rt_core/collision/mechanism.hpp"
#include "rt_core/collision/pairs.hpp"
#include "rt_core/engine/tick_state.hpp"

namespace cellmirror::app {

class CollisionWatch {
 public:
  // A test at the first tick after each `period`; postures that are those of the test before are passed over.
  CollisionWatch(Timestamp begin, Nanoseconds period);

  void observe(const std::shared_ptr<const CellState>& cell_state, const engine::TickState& tick);
  // Nothing more may be observed.
  void finish(CollisionSummary& summary);

 private:
  void adopt(const CellState& cell_state);
  void derive(const CellState& cell_state);
  [[nodiscard]] bool same_posture(const engine::TickState& tick);
  void take_events(const ProximityState& found, double now_s);
  void take_depths(const ProximityState& found, double now_s);
  void take_distance(const ProximityState& found, double now_s);

  Timestamp begin_;
  Nanoseconds period_;
  Timestamp next_;
  collision::PairDerivation derivation_;
  collision::Checker checker_;
  CellPoser follower_{false};
  collision::RangeWatch ranges_;  // cleared with each new cell
  std::shared_ptr<const CellState> picture_;
  std::shared_ptr<const collision::Settings> settings_;
  bool tested_ = false;                                                      // the posture below
  std::vector<JointValues> posture_ = std::vector<JointValues>(kMaxRobots);  // by slot
  std::map<std::pair<std::string, std::string>, std::size_t> touching_;      // places in summary_.collisions
  CollisionSummary summary_;
};

}  // namespace cellmirror::app
