// What `cellmirror status` says of haptic devices, for people.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cellmirror::app {

// Empty where there is none.
[[nodiscard]] std::string haptics_table(const nlohmann::json& status);

}  // namespace cellmirror::app
