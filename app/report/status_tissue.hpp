// The part of the status document about deformable objects (docs/status.md).
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/tissue_report.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::app {

// null where there is no report: the cell has no deformable objects.
[[nodiscard]] nlohmann::json tissue_json(const std::shared_ptr<const TissueReport>& report, const CellState& cell,
                                         Timestamp now);

}  // namespace cellmirror::app
