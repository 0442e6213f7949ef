// How a new cell is tried without its robots: the command lines of sim_robot and the motions that they play. Pure.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/new_cell/plan.hpp"

namespace cellmirror::app {

// A motion table (docs/sim-devices.md) in which every joint goes a little to and fro within its range.
[[nodiscard]] std::string motion_text(const PlannedRobot& robot);
// The file of it in the cell folder.
[[nodiscard]] std::string motion_file(const PlannedRobot& robot);

struct Simulation {
  std::vector<std::string> words;  // program and arguments; empty: this robot cannot be simulated like this
  std::string why;                 // not
};
// To be run in the cell folder.
[[nodiscard]] Simulation simulation_of(const CellPlan& plan, const PlannedRobot& robot);
// simulators.txt: a name and a command a line.
[[nodiscard]] std::string simulators_text(const CellPlan& plan);
// README.md of the folder.
[[nodiscard]] std::string readme_text(const CellPlan& plan);

}  // namespace cellmirror::app
