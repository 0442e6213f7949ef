// The part of the status document about foot switches (docs/status.md).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/snapshot/foot_switch_snapshot.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json switches_json(const FootSwitchSnapshot& snapshot, Timestamp now);

}  // namespace cellmirror::app
