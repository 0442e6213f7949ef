// What is reported of each command, for the log of commands.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "scripts/runner/script_run.hpp"
#include "scripts/runner/script_runner.hpp"

namespace cellmirror::script {

namespace {

constexpr std::string_view kBlank = " \t\r\n";

// Without the comments in front, and the end of the command.
std::string plain_command(std::string_view text) {
  for (;;) {
    const std::size_t begin = text.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) return {};
    text.remove_prefix(begin);
    if (!text.starts_with('#')) break;
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end);
  }
  const std::size_t last = text.find_last_not_of(" \t\r\n;");
  return std::string(text.substr(0, last == std::string_view::npos ? 0 : last + 1));
}

void end_trace(CommandTrace& trace, const Clock& clock, const Result<std::string>& result) {
  trace.ended = clock.now();
  trace.done = result.has_value();
  trace.answer = result ? *result : result.error().text();
}

}  // namespace

CommandTrace ScriptRunner::trace_of(const CommandSource& source, std::string text, Timestamp began,
                                    const Result<std::string>& result) const {
  CommandTrace trace{.source = source, .text = std::move(text), .began = began};
  end_trace(trace, clock_, result);
  return trace;
}

CommandReply ScriptRunner::traced(const ScriptCommand& command, CommandReply reply) const {
  CommandTrace trace{.source = command.source, .text = command.text, .began = clock_.now()};
  // It may outlive the runner.
  return [trace = std::move(trace), reply = std::move(reply), call = traced_,
          &clock = clock_](const Result<std::string>& result) mutable {
    end_trace(trace, clock, result);
    (*call)(std::move(trace));
    reply(result);
  };
}

void ScriptRunner::trace_begin(ScriptRun& run, std::size_t from, int line) {
  if (!traced_) return;
  ScriptFile& file = *run.stack.back();
  const std::string_view text = file.text();
  const std::size_t end = std::min(file.reader().position().offset, text.size());
  CommandTrace trace{.run = run.report.id, .began = clock_.now()};
  trace.source.kind = CommandSource::Kind::file;
  trace.source.place = fmt::format("{}:{}", file.name(), line);
  if (from < end) trace.text = plain_command(text.substr(from, end - from));
  run.trace = std::move(trace);
}

void ScriptRunner::trace_end(ScriptRun& run, const Result<std::string>& result) {
  if (!run.trace) return;
  CommandTrace trace = std::move(*run.trace);
  run.trace.reset();
  end_trace(trace, clock_, result);
  (*traced_)(std::move(trace));
}

// The place is that of the trace.
void ScriptRunner::trace_refused(ScriptRun& run, const Diagnostics& findings) {
  if (!run.trace) return;
  Error error;
  for (const Diagnostic& finding : findings.all()) {
    if (finding.severity != Severity::error) continue;
    error.what += (error.what.empty() ? "" : " | ") + finding.message;
    if (error.remedy.empty()) error.remedy = finding.remedy;
  }
  trace_end(run, std::unexpected(std::move(error)));
}

}  // namespace cellmirror::script
