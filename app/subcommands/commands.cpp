// cellmirror commands: the table of all SCRIPT commands.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "app/subcommands/subcommand.hpp"
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

void add_commands(CLI::App& cli, Action& action) {
  auto options = std::make_shared<CommandsOptions>();
  CLI::App* sub = cli.add_subcommand("commands", "List the SCRIPT commands, or explain one");
  auto* name = sub->add_option("name", options->name, "the command to explain, e.g. POS_ROB");
  sub->add_flag("--json", options->json, "one JSON document with the whole table")->excludes(name);
  sub->footer("Example: cellmirror commands POS_ROB");
  sub->callback([options, &action] { action = [options] { return print_commands(*options); }; });
}

}  // namespace cellmirror::app
