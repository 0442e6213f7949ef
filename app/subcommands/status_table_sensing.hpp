// The lines of the status table about collisions and ultrasonic sensors.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cellmirror::app {

// Lines that end with a newline; empty where the document has nothing of it. Throws what nlohmann::json throws where
// the document has another shape.
[[nodiscard]] std::string sensing_table(const nlohmann::json& status);

}  // namespace cellmirror::app
