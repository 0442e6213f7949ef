// The part of `cellmirror status` about I/O nodes.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cellmirror::app {

[[nodiscard]] std::string io_nodes_table(const nlohmann::json& status);

}  // namespace cellmirror::app
