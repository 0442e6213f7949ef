// Which SCRIPT commands are executed where a recording is played.
#pragma once

#include <optional>

#include "rt_core/base/result.hpp"
#include "scripts/lang/form_id.hpp"
#include "scripts/runner/script_command.hpp"

namespace cellmirror::app {

// Why a command is not executed; none: it is. What only shows the cell in another way is. The startup script sets up
// the model, too; what moves robots, or opens devices, comes from the recording.
[[nodiscard]] std::optional<Error> withheld_in_playback(script::FormId command, script::CommandSource::Kind from);

}  // namespace cellmirror::app
