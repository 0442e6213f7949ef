// The simulation of tissue off line: as many steps as milliseconds of simulated time have passed. One thread.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "app/simulation/simulation_result.hpp"
#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/tissue_port.hpp"
#include "app/workers/tissue_stepper.hpp"
#include "config/tissue_setup.hpp"
#include "rt_core/engine/tick_state.hpp"

namespace cellmirror::app {

class OffLineTissue final : public TissuePort {
 public:
  // Null where the cell has no deformable objects.
  static Result<std::unique_ptr<OffLineTissue>> make(const TissueSetup& setup, Timestamp begin);
  OffLineTissue(tissue::World world, Timestamp begin);

  // Applied at once.
  Result<void> request(std::vector<tissue::Command> commands) override;
  void observe(const CellState& cell_state, const engine::TickState& tick);
  void finish(TissueSummary& summary) const;

 private:
  void keep_events();

  TissueStepper stepper_;
  Timestamp begin_;
  Timestamp next_;
  TissueSummary summary_;
};

}  // namespace cellmirror::app
