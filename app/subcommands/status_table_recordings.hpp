// The recordings of a gateway in the table of `status`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cellmirror::app {

[[nodiscard]] std::string recordings_table(const nlohmann::json& status);
// "60.0 s, 1200 messages, 1.2 MB, 0 dropped" of one of them.
[[nodiscard]] std::string recording_figures(const nlohmann::json& recording);

}  // namespace cellmirror::app
