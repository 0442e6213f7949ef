// What the monitor page shows of voxel volumes (docs/monitor-page.md).
#pragma once

#include "app/snapshot/cell_state.hpp"
#include "rt_core/base/json_writer.hpp"

namespace cellmirror::app {

// The member `volumes` of `live`: what is in force; null where the cell has no voxel volume.
void add_volumes(JsonWriter& out, const CellState& cell);

// The member `volumes` of the tree: what does not change while a volume is loaded, histograms among it.
void add_volume_contents(JsonWriter& out, const CellState& cell);

}  // namespace cellmirror::app
