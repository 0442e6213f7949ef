// Voxel volumes in the table of `cellmirror status`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cellmirror::app {

// Empty for a cell without them, and for an older gateway. Throws json::exception for a document of another shape.
[[nodiscard]] std::string volumes_table(const nlohmann::json& status);

}  // namespace cellmirror::app
