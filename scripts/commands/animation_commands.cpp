// Manual 1.2.3.
#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

// SET_MODE's identifiers: those of the manual in the order of DisplayMode, then ours.
constexpr std::size_t kLegend = kDisplayModes;

ViewPace pace_of(const ParsedCommand& command) {
  if (command.given(slots::stvw::kSteps))
    return InSteps{static_cast<std::uint64_t>(command.integer(slots::stvw::kSteps))};
  if (command.given(slots::stvw::kTime))
    return InTime{Nanoseconds(static_cast<std::int64_t>(command.number(slots::stvw::kTime) * 1e9))};
  return AtOnce{};
}

Outcome set_display(const ParsedCommand& command, CommandHost& host) {
  const bool full_screen = command.given(slots::stdp::kScreen) && command.choice(slots::stdp::kScreen) == 0;
  return Outcome::of(host.display.set_display(static_cast<int>(command.integer(slots::stdp::kDisplay)), full_screen));
}

Outcome set_view(const ParsedCommand& command, CommandHost& host) {
  const auto vector = [&](const Slot& slot) -> std::optional<Eigen::Vector3d> {
    if (!command.given(slot)) return std::nullopt;
    return vector_at(command, slot);
  };
  const auto number = [&](const Slot& slot) -> std::optional<double> {
    if (!command.given(slot)) return std::nullopt;
    return command.number(slot);
  };
  namespace at = slots::stvw;
  const ViewChange change{vector(at::kViewpoint), vector(at::kLookpoint),  number(at::kTwist),
                          number(at::kAngle),     number(at::kFrontPlane), number(at::kBackPlane)};
  return Outcome::of(host.display.set_view(static_cast<int>(command.integer(at::kView)), change, pace_of(command)));
}

Outcome connect_view(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.connect_view(static_cast<int>(command.integer(slots::covw::kView)),
                                               command.text(slots::covw::kCamera)));
}

// The first choice of all switches is "on".
Outcome set_mode(const ParsedCommand& command, CommandHost& host) {
  const bool on = command.choice(slots::set_mode::kOn) == 0;
  if (command.choice(slots::set_mode::kMode) == kLegend) return Outcome::of(host.display.set_legend(on));
  return Outcome::of(host.display.set_mode(static_cast<DisplayMode>(command.choice(slots::set_mode::kMode)), on));
}

template <DisplayMode mode>
Outcome switch_mode(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.set_mode(mode, command.choice(kOnlySlot) == 0));
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
