// Robot programs: those of manual 1.2.1, and our own commands.
#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

// Of a command that may continue.
Outcome begun(Result<ActivityHandle> result) {
  if (!result) return Outcome::refused(std::move(result.error()));
  return *result ? Outcome::pending(std::move(*result)) : Outcome::done();
}

Outcome load(const ParsedCommand& command, CommandHost& host) {
  return begun(
      host.programs.load_program(command.text(slots::program::kProgram), command.text(slots::program::kRobot)));
}

Outcome run(const ParsedCommand& command, CommandHost& host) {
  const ProgramBegin begin = command.given(slots::program::kExecWait) ? ProgramBegin::exec_wait : ProgramBegin::now;
  return begun(
      host.programs.run_program(command.text(slots::program::kProgram), command.text(slots::program::kRobot), begin));
}

Outcome run_backward(const ParsedCommand& command, CommandHost& host) {
  return begun(host.programs.run_program(command.text(slots::program::kProgram), command.text(slots::program::kRobot),
                                         ProgramBegin::backward));
}

Outcome delete_program(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(
      host.programs.delete_program(command.text(slots::program::kProgram), command.text(slots::program::kRobot)));
}

Outcome hold(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.programs.hold_program(command.text(kOnlySlot)));
}
Outcome resume(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.programs.resume_program(command.text(kOnlySlot)));
}
Outcome step(const ParsedCommand& command, CommandHost& host) {
  const bool backward =
      command.given(slots::program_step::kDirection) && command.choice(slots::program_step::kDirection) == 1;
  return Outcome::of(host.programs.step_program(command.text(slots::program_step::kRobot), backward));
}
Outcome stop(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.programs.stop_programs(command.text(kOnlySlot)));
}

Outcome await(const ParsedCommand& command, CommandHost& host) {
  return begun(host.programs.await_programs(command.text(kOnlySlot)));
}

Outcome record(const ParsedCommand& command, CommandHost& host) {
  const auto what = static_cast<RecordStep>(command.choice(slots::program::kRecordStep));
  const std::string_view point =
      command.given(slots::program::kPoint) ? command.text(slots::program::kPoint) : std::string_view();
  if (!point.empty() && what != RecordStep::point) {
    return Outcome::refused(
        {"TF_RECORD: a name is allowed with POINT only", "e.g. TF_RECORD taught PUMA_762 POINT grip"});
  }
  return Outcome::of(host.programs.record_program(command.text(slots::program::kProgram),
                                                  command.text(slots::program::kRobot), what, point));
}

// The first choice is "on".
Outcome set_input(const ParsedCommand& command, CommandHost& host) {
  const auto number = static_cast<std::size_t>(command.integer(slots::program_input::kNumber));
  return Outcome::of(host.programs.set_digital_input(command.text(slots::program_input::kRobot), number,
                                                     command.choice(slots::program_input::kOn) == 0));
}
Outcome set_analogue_input(const ParsedCommand& command, CommandHost& host) {
  const auto number = static_cast<std::size_t>(command.integer(slots::program_input::kNumber));
  return Outcome::of(host.programs.set_analogue_input(command.text(slots::program_input::kRobot), number,
                                                      command.number(slots::program_input::kValue)));
}

constexpr Registration kHandlers[] = {
    {FormId::tf_load, load},         {FormId::tf_run, run},          {FormId::tf_delete, delete_program},
    {FormId::tf_back, run_backward}, {FormId::tf_hold, hold},        {FormId::tf_resume, resume},
    {FormId::tf_step, step},         {FormId::tf_stop, stop},        {FormId::tf_wait, await},
    {FormId::tf_record, record},     {FormId::set_input, set_input}, {FormId::set_analog_input, set_analogue_input},
};

}  // namespace

std::span<const Registration> program_handlers() { return kHandlers; }

}  // namespace cellmirror::script
