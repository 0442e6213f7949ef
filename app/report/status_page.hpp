// The monitor page's part of the status document (docs/status.md, `page`).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/report/page_report.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json page_json(const PageReport& report);

}  // namespace cellmirror::app
