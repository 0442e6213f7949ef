// Robot programs in the table of `cellmirror status`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cellmirror::app {

// Empty where nothing of the kind is there.
[[nodiscard]] std::string programs_table(const nlohmann::json& status);

}  // namespace cellmirror::app
