// Commands that the manual does not have.
#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

Outcome save_flight(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.diagnosis.save_flight_record(command.text(0)));
}

constexpr Registration kHandlers[] = {
    {FormId::save_flight, save_flight},
};

}  // namespace

std::span<const Registration> own_handlers() { return kHandlers; }

}  // namespace cellmirror::script
