// The part of `cellmirror status` about ROS 2 controllers.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cellmirror::app {

[[nodiscard]] std::string controllers_table(const nlohmann::json& status);

}  // namespace cellmirror::app
