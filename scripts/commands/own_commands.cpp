// Commands that the manual does not have.
#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

Outcome save_flight(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.diagnosis.save_flight_record(command.text(kOnlySlot)));
}

Outcome record_black_box(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.diagnosis.record(static_cast<RecordAction>(command.choice(kOnlySlot))));
}

Outcome acknowledge_alarms(const ParsedCommand& command, CommandHost& host) {
  using namespace slots::alarm_ack;
  const bool one = command.given(kAlarm);
  return Outcome::with_remark(host.diagnosis.acknowledge_alarms(
      command.text(kName), one ? static_cast<std::uint64_t>(command.integer(kAlarm)) : 0));
}

Outcome reset_haptic(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.interaction.reset_haptic(command.text(kOnlySlot)));
}

Outcome save_views(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.save_views(command.text(kOnlySlot)));
}

// A robot without a program or a move of ours has nothing to stop: its refusal is no error here.
Outcome stop_all(const ParsedCommand& /*command*/, CommandHost& host) {
  for (const std::string& robot : host.names.all(NameKind::robot)) {
    [[maybe_unused]] const Result<void> programs = host.programs.stop_programs(robot);
    [[maybe_unused]] const Result<void> moves = host.motion.stop(robot);
  }
  return Outcome::stop_runs(Outcome::kAllRuns);
}

Outcome stop_script(const ParsedCommand& command, CommandHost& /*host*/) {
  return Outcome::stop_runs(static_cast<std::uint64_t>(command.integer(kOnlySlot)));
}

constexpr Registration kHandlers[] = {
    {FormId::save_views, save_views},        {FormId::save_flight, save_flight},
    {FormId::reset_haptic, reset_haptic},    {FormId::stop_all, stop_all},
    {FormId::stop_script, stop_script},      {FormId::record, record_black_box},
    {FormId::alarm_ack, acknowledge_alarms},
};

}  // namespace

std::span<const Registration> own_handlers() { return kHandlers; }

}  // namespace cellmirror::script
