// The level of detail at which a node of the cell is shown.
#pragma once

#include <vector>

#include "rt_core/cell/cell.hpp"

namespace cellmirror::app {

struct NodeLevel {
  bool has_detail = false;  // there is an ABSTRACT file for it
  Shown shown = Shown::detail;
};
using LevelList = std::vector<NodeLevel>;  // by node of the compiled cell

}  // namespace cellmirror::app
