// The part of the status document about robot programs (docs/status.md).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/gateway/program_picture.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json programs_json(const ProgramsPicture& programs);

}  // namespace cellmirror::app
