// I/O nodes in the status document.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/snapshot/cell_state.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json io_nodes_json(const CellState& cell_state);

}  // namespace cellmirror::app
