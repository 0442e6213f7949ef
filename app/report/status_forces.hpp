// The part of the status document about forces (docs/status.md).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/snapshot/force_report.hpp"
#include "app/snapshot/force_settings.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json forces_json(const ForceReport& report, const ForceSettings& settings, Timestamp now);

}  // namespace cellmirror::app
