// Commands that come as messages.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rt_core/base/counted.hpp"
#include "scripts/lang/reader.hpp"
#include "scripts/runner/script_run.hpp"
#include "scripts/runner/script_runner.hpp"

namespace cellmirror::script {

namespace {

// All diagnostics in one line, for the answer to a message: "what; remedy | what". A place is given only where the
// message has several lines: most are one line that their sender sees.
Error as_error(const Diagnostics& findings) {
  constexpr std::size_t kShown = 8;
  Error error;
  std::size_t shown = 0;
  for (const Diagnostic& finding : findings.all()) {
    if (finding.severity != Severity::error) continue;
    if (++shown > kShown) break;
    if (shown > 1) error.what += " | ";
    if (finding.place.line > 1) error.what += fmt::format("{}:{}: ", finding.place.line, finding.place.column);
    error.what += finding.message;
    if (shown == 1) error.remedy = finding.remedy;
  }
  return error;
}

bool waits_for_programs(FormId id) { return id == FormId::wait || id == FormId::tf_wait; }

}  // namespace

// Programs load and begin later, when their errors are found. (A robot that does not arrive has got another command.)
bool ScriptRunner::may_be_wrong_later(FormId id) {
  return id == FormId::tf_load || id == FormId::tf_run || id == FormId::tf_back;
}

Result<std::string> ScriptRunner::execute_message(std::string_view text, std::string_view source,
                                                  CommandSource::Kind from) {
  ActivityHandle activity;
  auto result = begin_message(command_, from, text, source, activity);
  if (result) return *std::move(result);
  const Result<std::string> begun;
  if (may_be_wrong_later(command_.id())) {
    const Place place{std::string(source), command_.begin().line, command_.begin().column};
    waiting_messages_.push_back({from, std::move(activity), place, {}});
  } else {
    count_message(from, begun, {});
  }
  return begun;
}

void ScriptRunner::execute_message(std::string_view text, std::string_view source, CommandReply reply,
                                   CommandSource::Kind from) {
  ActivityHandle activity;
  if (const auto result = begin_message(command_, from, text, source, activity)) {
    reply(*result);
    return;
  }
  const Place place{std::string(source), command_.begin().line, command_.begin().column};
  waiting_messages_.push_back({from, std::move(activity), place, std::move(reply)});
}

void ScriptRunner::execute(ScriptCommand command) {
  const std::string source = command.source.text();
  const CommandSource::Kind from = command.source.kind;
  const bool answered = command.reply.wanted();
  if (traced_) command.reply = traced(command, std::move(command.reply));
  if (answered) return execute_message(command.text, source, std::move(command.reply), from);
  // Without a reply nothing waits for a robot to arrive. Refusals are listed in status.
  command.reply(execute_message(command.text, source, from));
}

Result<ActivityHandle> ScriptRunner::execute_program_command(std::string_view text, std::string_view source) {
  ActivityHandle activity;
  const Timestamp began = clock_.now();
  auto result = begin_message(program_command_, CommandSource::Kind::program, text, source, activity);
  if (traced_) {
    const CommandSource program{.kind = CommandSource::Kind::program, .place = std::string(source)};
    (*traced_)(trace_of(program, std::string(text), began, result.value_or(std::string())));
  }
  if (result) {
    if (!*result) return std::unexpected(std::move(result->error()));
    return ActivityHandle();
  }
  const Place place{std::string(source), program_command_.begin().line, program_command_.begin().column};
  waiting_messages_.push_back({CommandSource::Kind::program, activity, place, {}});
  return activity;
}

SourceCounters& ScriptRunner::counters_of(CommandSource::Kind from) {
  switch (from) {
    case CommandSource::Kind::file:
      return counters_.file;
    case CommandSource::Kind::message:
    case CommandSource::Kind::page:
    case CommandSource::Kind::mqtt:
      return counters_.message;
    case CommandSource::Kind::program:
      return counters_.program;
  }
  return counters_.message;
}

std::optional<Result<std::string>> ScriptRunner::begin_message(ParsedCommand& command, CommandSource::Kind from,
                                                               std::string_view text, std::string_view source,
                                                               ActivityHandle& activity) {
  ++counters_of(from).received;
  CommandReader reader(text, source, TextKind::message);
  Diagnostics findings;
  const CommandReader::Step step = reader.next(&host_.names, command, findings);
  if (step == CommandReader::Step::error) {
    for (const Diagnostic& finding : findings.all()) remember(finding);
    ++counters_of(from).refused;
    return std::unexpected(as_error(findings));
  }
  Result<std::string> result;
  if (step == CommandReader::Step::command && from == CommandSource::Kind::program &&
      waits_for_programs(command.id())) {
    result = fail(fmt::format("{}: a robot program cannot wait for programs", command.form().name),
                  "synchronise programs by semaphores");
  } else if (step == CommandReader::Step::command) {
    std::optional<Error> withheld;
    if (events_.withheld) withheld = events_.withheld(command.id(), from);
    Outcome outcome = withheld ? Outcome::refused(*std::move(withheld)) : script::execute(command, host_);
    if (outcome.kind == Outcome::Kind::pending) {
      activity = std::move(outcome.activity);
      return std::nullopt;
    }
    result = accept_message(outcome, from);
  }
  count_message(from, result, {std::string(source), command.begin().line, command.begin().column});
  return result;
}

void ScriptRunner::count_message(CommandSource::Kind from, const Result<std::string>& result, const Place& place) {
  SourceCounters& counters = counters_of(from);
  ++(result ? counters.done : counters.refused);
  if (!result) remember({Severity::error, place, result.error().what, result.error().remedy});
}

Result<std::string> ScriptRunner::accept_message(const Outcome& outcome, CommandSource::Kind from) {
  switch (outcome.kind) {
    case Outcome::Kind::done:
    case Outcome::Kind::pending:
      return outcome.remark;
    case Outcome::Kind::refused:
      return std::unexpected(outcome.error);
    case Outcome::Kind::wait:
      return fail("WAIT suspends the SCRIPT file that contains it; a message has none",
                  "put WAIT into a SCRIPT file and call it with EXEC_SCRIPT");
    case Outcome::Kind::stop_runs: {
      const auto stopped = stop_runs(outcome.run);
      if (!stopped) return std::unexpected(stopped.error());
      return number_of(*stopped, "SCRIPT file") + " stopped";
    }
    case Outcome::Kind::call_script: {
      if (auto room = room_for_run(from); !room) return std::unexpected(std::move(room.error()));
      const auto id = start_file(outcome.script);
      if (!id) return std::unexpected(id.error());
      runs_.back()->from = from;
      return fmt::format("{} started as run {}", runs_.back()->report.file, *id);
    }
  }
  return std::string{};
}

// Programs that send messages leave places to people, and both leave places to foot switches, so that none of them can
// lock the others out.
Result<void> ScriptRunner::room_for_run(CommandSource::Kind from) {
  const std::size_t most = from == CommandSource::Kind::page ? kMaxRunsOfPage : kMaxRunsOfMessages;
  const auto running = static_cast<std::size_t>(
      std::count_if(runs_.begin(), runs_.end(), [from](const auto& run) { return run->from == from; }));
  if (running < most) return {};
  ++counters_.scripts_refused;
  return fail(fmt::format("{} SCRIPT files that {} are running already", most,
                          from == CommandSource::Kind::page ? "the monitor page started" : "messages started"),
              "wait until one of them has ended, or end them: STOP_SCRIPT <run>, STOP_ALL");
}

std::size_t ScriptRunner::answer_messages() {
  std::size_t answered = 0;
  for (std::size_t i = 0; i < waiting_messages_.size();) {
    const Activity& activity = *waiting_messages_[i].activity;
    if (activity.state() == Activity::State::running) {
      ++i;
      continue;
    }
    Result<std::string> result;
    if (activity.state() == Activity::State::refused) result = std::unexpected(activity.error());
    // Taken out first: the reply may begin something.
    WaitingMessage ended = std::move(waiting_messages_[i]);
    waiting_messages_.erase(waiting_messages_.begin() + static_cast<std::ptrdiff_t>(i));
    end_message(ended, result);
    ++answered;
  }
  return answered;
}

void ScriptRunner::end_message(WaitingMessage& message, const Result<std::string>& result) {
  count_message(message.from, result, message.place);
  message.reply(result);
  if (result || !message.of_stopped_file || !events_.refused) return;
  Diagnostics findings;
  findings.error(message.place, result.error().what, result.error().remedy);
  events_.refused(findings);
}

void ScriptRunner::refuse_waiting_messages() {
  const Result<std::string> result = fail("the gateway ends");
  for (WaitingMessage& waiting : waiting_messages_) end_message(waiting, result);
  waiting_messages_.clear();
}

}  // namespace cellmirror::script
