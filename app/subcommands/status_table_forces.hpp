// The lines of `cellmirror status` about forces.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cellmirror::app {

// Empty where there is nothing to show. Throws nlohmann's exceptions where the document is another one than ours.
[[nodiscard]] std::string forces_table(const nlohmann::json& status);

}  // namespace cellmirror::app
