// The part of the status document about ROS 2 controllers (docs/status.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "app/snapshot/controller_snapshot.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/engine/tick_state.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json controllers_json(std::span<const ControllerSnapshot> controllers,
                                              const engine::TickState& tick, Timestamp now);

}  // namespace cellmirror::app
