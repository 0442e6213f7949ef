// Commands of the tick as bytes, with all that they lend, and back. Not for the tick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "rt_core/base/state_bytes.hpp"
#include "rt_core/engine/command.hpp"
#include "rt_core/kinematics/chain.hpp"

namespace cellmirror::engine {

class Engine;

// Enough for write_command().
[[nodiscard]] std::size_t most_bytes_of(const Command& command);
void write_command(StateWriter& out, Command& command);

// Who stands for what cannot be in a file.
struct CommandParts {
  Engine& engine;  // lends
  // Chains are distinguished by their ids, as the tick does it by their addresses: gives the one that was read under
  // this id before where it is the same, else keeps this one.
  std::function<std::shared_ptr<const kinematics::Chain>(std::uint64_t id, kinematics::Chain&& chain)> chain;
  // Stands for the device of a channel.
  std::function<std::shared_ptr<HapticDevicePort>(std::uint8_t channel, std::uint64_t id)> device;
};
// From any bytes: values are checked as the owner checks them. None, and `in` fails, where they cannot be a command's.
[[nodiscard]] std::optional<Command> read_command(StateReader& in, const CommandParts& parts);

}  // namespace cellmirror::engine
