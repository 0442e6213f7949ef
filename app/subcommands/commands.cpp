// cellmirror commands: the table of all SCRIPT commands.
#include <cstdio>
#include <memory>
#include <string>

#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"
#include "scripts/lang/command_table.hpp"
#include "scripts/lang/help.hpp"

namespace cellmirror::app {

namespace {

struct CommandsOptions {
  bool json = false;
  std::string name;
};

int print_commands(const CommandsOptions& options) {
  if (options.name.empty()) {
    std::fputs((options.json ? script::commands_as_json() : script::commands_as_text()).c_str(), stdout);
    return kExitDone;
  }
  const std::string help = script::help_text(options.name);
  if (script::forms_of(options.name).empty()) return refuse(help);
  std::fputs(help.c_str(), stdout);
  return kExitDone;
}

}  // namespace

void add_commands(cli::Command program, Action& action) {
  auto options = std::make_shared<CommandsOptions>();
  cli::Command sub = program.subcommand("commands", "List the SCRIPT commands, or explain one");
  auto name = sub.option("name", options->name, "the command to explain, e.g. POS_ROB");
  sub.flag("--json", options->json, "one JSON document with the whole table").excludes(name);
  sub.footer("Example: cellmirror commands POS_ROB");
  sub.when_named([options, &action] { action = [options] { return print_commands(*options); }; });
}

}  // namespace cellmirror::app
