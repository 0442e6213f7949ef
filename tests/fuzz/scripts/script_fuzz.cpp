// SCRIPT text as a file and as a message, with and without a directory of names; what is read is executed on a gateway
// that accepts everything. Besides crashes: a command is either read or has findings, and findings lie in the text.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "scripts/commands/execute.hpp"
#include "scripts/lang/help.hpp"
#include "scripts/lang/lexer.hpp"
#include "scripts/lang/reader.hpp"
#include "tests/golden/scripts/quiet_host.hpp"

namespace {

using namespace cellmirror;
using namespace cellmirror::script;

void require(bool holds) {
  if (!holds) std::abort();
}

void read(std::string_view text, TextKind kind, const NameDirectory* names, CommandHost* host) {
  CommandReader reader(text, "fuzz", kind);
  ParsedCommand command;
  Diagnostics findings;
  std::size_t offset = 0;
  for (;;) {
    const std::size_t errors_before = findings.errors();
    const CommandReader::Step step = reader.next(names, command, findings);
    if (step == CommandReader::Step::end) break;
    require((step == CommandReader::Step::error) == (findings.errors() > errors_before));
    // Every step that is no error moves on: reading ends.
    require(reader.position().offset > offset || kind == TextKind::message || step == CommandReader::Step::error);
    offset = reader.position().offset;
    if (step != CommandReader::Step::command) continue;
    require(command.size() <= kMaxValues);
    if (host != nullptr) static_cast<void>(execute(command, *host));
  }
  for (const Diagnostic& finding : findings.all()) {
    require(finding.place.line >= 0 && static_cast<std::size_t>(finding.place.line) <= text.size() + 1);
    require(finding.place.column >= 0 && static_cast<std::size_t>(finding.place.column) <= text.size() + 1);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static cellmirror::testing::QuietHost gateway;
  static CommandHost host = gateway.host();
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  gateway.names.active = "MANTEC_RM3";
  read(text, TextKind::file, &gateway.names, &host);
  gateway.names.active.clear();
  read(text, TextKind::message, &gateway.names, &host);
  read(text, TextKind::file, nullptr, nullptr);
  Diagnostics findings;
  check_script(text, "fuzz", &gateway.names, findings);
  static_cast<void>(joined_lines(text));
  if (size < 256) static_cast<void>(complete(text, &gateway.names));
  return 0;
}
