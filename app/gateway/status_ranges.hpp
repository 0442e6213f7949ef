// The part of the status document about ultrasonic sensors (docs/status.md).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/gateway/picture.hpp"
#include "app/gateway/ranging_worker.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json ranges_json(const RangeReport& report, const OwnerPicture& picture, Timestamp now);

}  // namespace cellmirror::app
