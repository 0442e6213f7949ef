// What the monitor page shows of deformable objects several times a second (docs/monitor-page.md, `live`).
#pragma once

#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/tissue_report.hpp"
#include "rt_core/base/json_writer.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::app {

// The member `tissue`; null where there is no report: the cell has no deformable objects.
void add_tissue(JsonWriter& out, const TissueReport* report, const CellState& cell, Timestamp now);

}  // namespace cellmirror::app
