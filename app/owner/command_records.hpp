// Commands as the log of commands keeps them.
#pragma once

#include <string>

#include "app/snapshot/command_record.hpp"
#include "rt_core/base/time.hpp"
#include "scripts/runner/command_trace.hpp"

namespace cellmirror::app {

[[nodiscard]] CommandRecord command_record_of(script::CommandTrace trace);
// Of one that was refused before anything was executed.
[[nodiscard]] CommandRecord refused_command(const script::CommandSource& source, std::string command, std::string why,
                                            Timestamp now);

}  // namespace cellmirror::app
