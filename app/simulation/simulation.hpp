// Runs a SCRIPT file and the robot programs that it starts against the cell, off line: with the owner, the controllers
// and the tick of the gateway, as fast as the machine can. docs/simulate.md.
#pragma once

#include <functional>
#include <string>

#include "app/simulation/simulation_result.hpp"
#include "config/cell_file.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

struct SimulationOptions {
  std::string script;  // any path, or the name of a file of the home's scripts/
  bool collisions = true;
  double collision_period_s = 0.001;  // of simulated time; at least a tick
  double longest_s = 3600;            // simulated time; then it is ended
  double still_s = 60;                // ended when nothing has happened for so long
};

// Called about once a simulated second.
using SimulationProgress = std::function<void(double simulated_s)>;

// Refused: the script cannot be started (missing, syntax errors). What goes wrong later is in the result. One thread;
// the same cell and script give the same result every time, but for SimulationResult::wall_s.
[[nodiscard]] Result<SimulationResult> simulate(LoadedCell cell, const SimulationOptions& options,
                                                const SimulationProgress& progress = {});

}  // namespace cellmirror::app
