// The log of commands as status and the page show it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/snapshot/command_record.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json command_log_json(const CommandLogReport& report);
// The same as a text, for the page.
[[nodiscard]] std::string command_log_document(const CommandLogReport& report);

}  // namespace cellmirror::app
