// The section `pictures` of the status document (docs/status.md).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/gateway/studio.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json pictures_json(const PictureReport& report);

}  // namespace cellmirror::app
