// The handlers of the commands, a list for each section of the manual. Private to the folder.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "scripts/commands/execute.hpp"
#include "scripts/lang/slots.hpp"

namespace cellmirror::script {

// The three numbers from this slot on.
[[nodiscard]] inline Eigen::Vector3d vector_at(const ParsedCommand& command, std::size_t slot) {
  return {command.number(slot), command.number(slot + 1), command.number(slot + 2)};
}

using Handler = Outcome (*)(const ParsedCommand& command, CommandHost& host);

struct Registration {
  FormId id;
  Handler handler;
};

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
