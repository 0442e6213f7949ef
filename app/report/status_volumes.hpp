// The part of the status document about voxel volumes (docs/status.md).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/snapshot/cell_state.hpp"

namespace cellmirror::app {

// An array; empty where the cell has no voxel volume.
[[nodiscard]] nlohmann::json volumes_json(const CellState& cell);

}  // namespace cellmirror::app
