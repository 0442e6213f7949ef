// Finds the constraints that the cell puts on the tip of an instrument: the worker's part of haptics. Not for the tick.
#pragma once

#include <memory>

#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/collision/pairs.hpp"
#include "rt_core/geometry/solid.hpp"
#include "rt_core/haptics/contact_model.hpp"

namespace cellmirror::contact_model {

struct FinderSettings {
  double reach_m = 0.01;  // the tip's way that a model is good for, at most: a metre a second for 10 ms
  // A gap is zero where the surfaces are still so far apart: there is a direction between them then.
  double margin_m = 2e-5;
};

struct FinderCounters {
  std::uint64_t models = 0;
  std::uint64_t uncertain = 0;
  std::uint64_t short_reach = 0;  // models with less reach than requested: too much is near
  std::uint64_t overlaps = 0;     // models with something deeper inside than the skin of a capsule
};

// One thread. No heap memory in steady state (but where bodies overlap deeply).
class ContactFinder {
 public:
  // `slot`: the instrument's robot. Its bodies are what its joints move, with all that is attached; the surroundings
  // are all other bodies with which the pair table tests them (so the trocar that guides a shaft is left out by a
  // rule).
  ContactFinder(std::size_t slot, const FinderSettings& settings);
  ~ContactFinder();
  ContactFinder(const ContactFinder&) = delete;
  ContactFinder& operator=(const ContactFinder&) = delete;

  // The cell has changed, or its pairs. Takes time for meshes that were not met before (some ms for thousands of
  // triangles).
  void adopt(std::shared_ptr<const CompiledCell> cell, std::shared_ptr<const collision::PairTable> pairs);
  // The constraints in the posture `poses` of the adopted cell: the nearest first, without those that others imply
  // (selection.hpp). Numbered from 1; without an adopted cell, and where its robot is gone, number 0 and nothing in it.
  void find(const CellPoses& poses, Timestamp posture_time, haptics::ContactModel& out);

  [[nodiscard]] const FinderCounters& counters() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cellmirror::contact_model
