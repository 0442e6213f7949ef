// The parts of `cellmirror status` about foot switches and coupled robots.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cellmirror::app {

// Empty where no memory of foot switches was named.
[[nodiscard]] std::string switches_table(const nlohmann::json& status);
// Empty where no robot follows another.
[[nodiscard]] std::string couplings_table(const nlohmann::json& status);

}  // namespace cellmirror::app
