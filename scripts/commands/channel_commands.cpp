// Manual 1.2.6, the I/O channels.
#include <cstddef>
#include <cstdint>

#include "scripts/commands/registry.hpp"
#include "scripts/lang/lexer.hpp"

namespace cellmirror::script {

namespace {

// The text may run over several lines of a SCRIPT file; it is shown on one.
Outcome show_message(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.show_message(joined_lines(command.text(kOnlySlot))));
}

// A System V key is a 32-bit pattern; the command accepts the whole of it as a positive number.
std::int32_t key_of(const ParsedCommand& command, std::size_t slot) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(command.integer(slot)));
}

Outcome set_force_memory(const ParsedCommand& command, CommandHost& host) {
  return Outcome::with_remark(
      host.interaction.set_force_memory(static_cast<std::uint64_t>(command.integer(slots::force_memory::kSendType)),
                                        key_of(command, slots::force_memory::kKey),
                                        static_cast<std::size_t>(command.integer(slots::force_memory::kBytes))));
}

Outcome set_switch_memory(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(
      host.interaction.set_switch_memory(static_cast<std::uint64_t>(command.integer(slots::switch_memory::kSendType)),
                                         key_of(command, slots::switch_memory::kKey),
                                         static_cast<std::size_t>(command.integer(slots::switch_memory::kBytes))));
}

Outcome set_switches_online(const ParsedCommand& command, CommandHost& host) {
  constexpr std::size_t kOnline = 0;
  return Outcome::of(host.interaction.set_switches_online(command.choice(kOnlySlot) == kOnline));
}

constexpr Registration kHandlers[] = {
    {FormId::rob_ela_shm, set_force_memory},
    {FormId::bin_ela_shm, set_switch_memory},
    {FormId::bin_ela, set_switches_online},
    {FormId::hot_message, show_message},
};

}  // namespace

std::span<const Registration> channel_handlers() { return kHandlers; }

}  // namespace cellmirror::script
