// The part of the status document about the picture, as SCRIPT has set it (docs/status.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "rt_core/base/time.hpp"
#include "rt_core/ports/display_state.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json display_json(const DisplayState& display, Timestamp now);

}  // namespace cellmirror::app
