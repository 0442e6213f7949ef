// The texts of a new cell: cell.toml, the components of robots that are made up, the startup script. Pure.
#pragma once

#include <string>

#include "app/new_cell/plan.hpp"

namespace cellmirror::app {

// Comments that begin with "DECIDE:" mark what a person has to decide.
[[nodiscard]] std::string cell_text(const CellPlan& plan);
// A component file for a robot of drives or signals of which no model exists: its joints one above the other.
[[nodiscard]] std::string axes_text(const PlannedRobot& robot);
// The joints of such a robot: J_1, J_2, ..., turning through a turn each.
[[nodiscard]] std::vector<PlannedJoint> made_up_joints(std::size_t count);
[[nodiscard]] std::string startup_text(const CellPlan& plan);

}  // namespace cellmirror::app
