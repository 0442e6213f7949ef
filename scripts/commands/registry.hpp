// The handlers of the commands, a list for each section of the manual. Private to the folder.
#pragma once

#include <span>

#include "scripts/commands/execute.hpp"

namespace cellmirror::script {

using Handler = Outcome (*)(const ParsedCommand& command, CommandHost& host);

struct Registration {
  FormId id;
  Handler handler;
};

// Refuses with "<name> is not available yet: <subsystem>".
Outcome not_available(const ParsedCommand& command, CommandHost& host);

std::span<const Registration> general_handlers();
std::span<const Registration> robot_parameter_handlers();
std::span<const Registration> animation_handlers();
std::span<const Registration> dynamics_handlers();
std::span<const Registration> elastodynamic_handlers();
std::span<const Registration> channel_handlers();
std::span<const Registration> volume_handlers();
std::span<const Registration> motion_handlers();
std::span<const Registration> program_handlers();
std::span<const Registration> sensing_handlers();
std::span<const Registration> own_handlers();

}  // namespace cellmirror::script
