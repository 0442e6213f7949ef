// Manual 1.2.3.
#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

// Slots and parameters of STVW, in the order of the table.
constexpr std::size_t kStepsParameter = 7;
constexpr std::size_t kTimeParameter = 8;

Outcome set_display(const ParsedCommand& command, CommandHost& host) {
  const bool full_screen = command.given(1) && command.choice(1) == 0;
  return Outcome::of(host.views.set_display(static_cast<int>(command.integer(0)), full_screen));
}

Outcome set_view(const ParsedCommand& command, CommandHost& host) {
  if (command.given(kStepsParameter) || command.given(kTimeParameter)) {
    return Outcome::refused({"STVW with STEPS or TIME is not available yet: view sequences",
                             "without STEPS and TIME the view is set at once"});
  }
  const auto vector = [&](std::size_t parameter, std::size_t slot) -> std::optional<Eigen::Vector3d> {
    if (!command.given(parameter)) return std::nullopt;
    return Eigen::Vector3d(command.number(slot), command.number(slot + 1), command.number(slot + 2));
  };
  const auto number = [&](std::size_t parameter, std::size_t slot) -> std::optional<double> {
    if (!command.given(parameter)) return std::nullopt;
    return command.number(slot);
  };
  const ViewChange change{vector(1, 1), vector(2, 4), number(3, 7), number(4, 8), number(5, 9), number(6, 10)};
  return Outcome::of(host.views.set_view(static_cast<int>(command.integer(0)), change));
}

Outcome wait(const ParsedCommand& /*command*/, CommandHost& /*host*/) {
  Outcome outcome;
  outcome.kind = Outcome::Kind::wait;
  return outcome;
}

constexpr Registration kHandlers[] = {
    {FormId::stdp, set_display},       {FormId::stvw, set_view},      {FormId::covw, not_available},
    {FormId::set_mode, not_available}, {FormId::bfrm, not_available}, {FormId::fldr, not_available},
    {FormId::shad, not_available},     {FormId::wait, wait},
};

}  // namespace

std::span<const Registration> animation_handlers() { return kHandlers; }

}  // namespace cellmirror::script
