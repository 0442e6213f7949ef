// Commands that the manual does not have.
#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

Outcome save_flight(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.diagnosis.save_flight_record(command.text(kOnlySlot)));
}

Outcome reset_haptic(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.interaction.reset_haptic(command.text(kOnlySlot)));
}

Outcome save_views(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.save_views(command.text(kOnlySlot)));
}

constexpr Registration kHandlers[] = {
    {FormId::save_views, save_views},
    {FormId::save_flight, save_flight},
    {FormId::reset_haptic, reset_haptic},
};

}  // namespace

std::span<const Registration> own_handlers() { return kHandlers; }

}  // namespace cellmirror::script
