// The section `haptics` of the status document.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/contact_report.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/engine/tick_state.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json haptics_json(const CellState& cell_state, const engine::TickState& tick,
                                          const ContactReport& contacts, Timestamp now);

}  // namespace cellmirror::app
