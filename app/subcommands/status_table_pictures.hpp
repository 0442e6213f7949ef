// The part of `cellmirror status` about pictures.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cellmirror::app {

// Empty where no picture was wanted yet and nothing is wrong.
[[nodiscard]] std::string pictures_table(const nlohmann::json& status);

}  // namespace cellmirror::app
