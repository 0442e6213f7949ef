// The part of the status document about robots that follow others (docs/status.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "app/snapshot/coupling_snapshot.hpp"
#include "rt_core/engine/tick_state.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json couplings_json(std::span<const CouplingSnapshot> couplings, const engine::TickState& tick);

}  // namespace cellmirror::app
