// Manual 1.2.6.
#include "scripts/commands/registry.hpp"
#include "scripts/lang/lexer.hpp"

namespace cellmirror::script {

namespace {

// The text may run over several lines of a SCRIPT file; it is shown on one.
Outcome show_message(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.views.show_message(joined_lines(command.text(0))));
}

constexpr Registration kHandlers[] = {
    {FormId::eladyn_calc, not_available},  {FormId::rob_ela_interact, not_available},
    {FormId::ela_clip_def, not_available}, {FormId::eladyn_geo_def_cylinders, not_available},
    {FormId::rob_ela_shm, not_available},  {FormId::bin_ela_shm, not_available},
    {FormId::bin_ela, not_available},      {FormId::hot_message, show_message},
};

}  // namespace

std::span<const Registration> channel_handlers() { return kHandlers; }

}  // namespace cellmirror::script
