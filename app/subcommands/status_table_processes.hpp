// The confined processes of a gateway in the table of `status`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cellmirror::app {

[[nodiscard]] std::string processes_table(const nlohmann::json& status);

}  // namespace cellmirror::app
