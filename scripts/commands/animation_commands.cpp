// Manual 1.2.3.
#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

Outcome wait(const ParsedCommand& /*command*/, CommandHost& /*host*/) {
  Outcome outcome;
  outcome.kind = Outcome::Kind::wait;
  return outcome;
}

constexpr Registration kHandlers[] = {
    {FormId::stdp, not_available},     {FormId::stvw, not_available}, {FormId::covw, not_available},
    {FormId::set_mode, not_available}, {FormId::bfrm, not_available}, {FormId::fldr, not_available},
    {FormId::shad, not_available},     {FormId::wait, wait},
};

}  // namespace

std::span<const Registration> animation_handlers() { return kHandlers; }

}  // namespace cellmirror::script
