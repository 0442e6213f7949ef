// The table that `cellmirror status` prints for people.
#pragma once

#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"

namespace cellmirror::app {

// `json`: the document of docs/status.md. `colour`: with terminal colours for what is stale, lost or invalid.
[[nodiscard]] Result<std::string> status_table(std::string_view json, bool colour);

}  // namespace cellmirror::app
