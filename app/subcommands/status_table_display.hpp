// What `cellmirror status` prints about the picture.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cellmirror::app {

// Lines, each with its end; nothing where the document has no such section.
[[nodiscard]] std::string display_table(const nlohmann::json& status);

}  // namespace cellmirror::app
