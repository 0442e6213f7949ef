// The part of the status document about robot programs (docs/status.md).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/snapshot/program_snapshot.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json programs_json(const ProgramsSnapshot& programs);

}  // namespace cellmirror::app
