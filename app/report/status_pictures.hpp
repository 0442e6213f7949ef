// The section `pictures` of the status document (docs/status.md).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/snapshot/render_report.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json pictures_json(const RenderReport& report);

}  // namespace cellmirror::app
