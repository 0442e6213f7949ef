// The part of the status document about ultrasonic sensors (docs/status.md).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/range_report.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json ranges_json(const RangeReport& report, const CellState& cell_state, Timestamp now);

}  // namespace cellmirror::app
