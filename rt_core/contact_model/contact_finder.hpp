// Finds the constraints that the cell puts on the tip of an instrument: the worker's part of haptics. Not for the tick.
#pragma once

#include <memory>

#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/collision/pairs.hpp"
#include "rt_core/geometry/solid.hpp"
#include "rt_core/haptics/contact_model.hpp"

namespace cellmirror::contact_model {

struct FinderSettings {
  double reach_m = 0.02;  // what is farther from the instrument than this is left out
};

// One thread. No heap memory in steady state.
class ContactFinder {
 public:
  // `slot`: the instrument's robot. Its bodies are what its joints move, with all that is attached; the surroundings
  // are all other bodies with which the pair table tests them (so the trocar that guides a shaft is left out by a
  // rule).
  ContactFinder(std::shared_ptr<geometry::SolidLibrary> solids, std::size_t slot, const FinderSettings& settings);
  ~ContactFinder();
  ContactFinder(const ContactFinder&) = delete;
  ContactFinder& operator=(const ContactFinder&) = delete;

  void adopt(std::shared_ptr<const CompiledCell> cell, std::shared_ptr<const collision::PairTable> pairs);
  // In the posture `poses`, which is that of the instrument at joint values `q` (all joints of its robot). The nearest
  // kMaxConstraints, nearest first, spread so that several on the same flat face do not crowd out others.
  void find(const CellPoses& poses, std::span<const double> q, Timestamp posture_time, haptics::ContactModel& out);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cellmirror::contact_model
