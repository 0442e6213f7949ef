// Manual 1.2.3.
#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

// Slots and parameters of STVW, in the order of the table.
constexpr std::size_t kStepsParameter = 7;
constexpr std::size_t kTimeParameter = 8;
constexpr std::size_t kStepsSlot = 11;
constexpr std::size_t kTimeSlot = 12;

// SET_MODE's identifiers: those of the manual in the order of DisplayMode, then ours.
constexpr std::size_t kLegend = kDisplayModes;

ViewPace pace_of(const ParsedCommand& command) {
  if (command.given(kStepsParameter)) return InSteps{static_cast<std::uint64_t>(command.integer(kStepsSlot))};
  if (command.given(kTimeParameter))
    return InTime{Nanoseconds(static_cast<std::int64_t>(command.number(kTimeSlot) * 1e9))};
  return AtOnce{};
}

Outcome set_display(const ParsedCommand& command, CommandHost& host) {
  const bool full_screen = command.given(1) && command.choice(1) == 0;
  return Outcome::of(host.display.set_display(static_cast<int>(command.integer(0)), full_screen));
}

Outcome set_view(const ParsedCommand& command, CommandHost& host) {
  const auto vector = [&](std::size_t parameter, std::size_t slot) -> std::optional<Eigen::Vector3d> {
    if (!command.given(parameter)) return std::nullopt;
    return Eigen::Vector3d(command.number(slot), command.number(slot + 1), command.number(slot + 2));
  };
  const auto number = [&](std::size_t parameter, std::size_t slot) -> std::optional<double> {
    if (!command.given(parameter)) return std::nullopt;
    return command.number(slot);
  };
  const ViewChange change{vector(1, 1), vector(2, 4), number(3, 7), number(4, 8), number(5, 9), number(6, 10)};
  return Outcome::of(host.display.set_view(static_cast<int>(command.integer(0)), change, pace_of(command)));
}

Outcome connect_view(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.connect_view(static_cast<int>(command.integer(0)), command.text(1)));
}

// The first choice of all switches is "on".
Outcome set_mode(const ParsedCommand& command, CommandHost& host) {
  const bool on = command.choice(1) == 0;
  if (command.choice(0) == kLegend) return Outcome::of(host.display.set_legend(on));
  return Outcome::of(host.display.set_mode(static_cast<DisplayMode>(command.choice(0)), on));
}

template <DisplayMode mode>
Outcome switch_mode(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.set_mode(mode, command.choice(0) == 0));
}

Outcome wait(const ParsedCommand& /*command*/, CommandHost& /*host*/) {
  Outcome outcome;
  outcome.kind = Outcome::Kind::wait;
  return outcome;
}

constexpr Registration kHandlers[] = {
    {FormId::stdp, set_display},
    {FormId::stvw, set_view},
    {FormId::covw, connect_view},
    {FormId::set_mode, set_mode},
    {FormId::bfrm, switch_mode<DisplayMode::backface_removal>},
    {FormId::fldr, switch_mode<DisplayMode::floor>},
    {FormId::shad, switch_mode<DisplayMode::shadows>},
    {FormId::wait, wait},
};

}  // namespace

std::span<const Registration> animation_handlers() { return kHandlers; }

}  // namespace cellmirror::script
