// cellmirror wall: one page for the cells of a plant.
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "app/subcommands/end_signals.hpp"
#include "app/subcommands/subcommand.hpp"
#include "app/wall/wall_run.hpp"
#include "config/command_line/command_line.hpp"
#include "config/wall_file.hpp"
#include "ipc/web/access.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::app {

namespace {

struct WallCommand {
  std::string cells;
  std::string state;
  std::optional<int> port;
  std::optional<int> domain;
  std::optional<std::string> bind;
  std::optional<std::string> interface_address;
  bool allow_remote = false;
  bool json = false;
  bool verbose = false;
  double seconds = 0;  // 0: until a signal
};

constexpr double kListen_s = 3;  // for --json without --for

// Errors are printed.
std::optional<WallSettings> settings_of(const WallCommand& command) {
  WallSettings settings;
  if (!command.cells.empty()) {
    Diagnostics diagnostics;
    auto read = read_wall(command.cells, diagnostics);
    std::fputs(diagnostics.text().c_str(), stderr);
    if (!read) return std::nullopt;
    settings = std::move(*read);
  }
  settings.port = command.port.value_or(settings.port);
  settings.domain = command.domain.value_or(settings.domain);
  settings.interface_address = command.interface_address.value_or(settings.interface_address);
  settings.address = command.bind.value_or(settings.address);
  return settings;
}

int run_wall(const WallCommand& command) {
  set_log_level(command.verbose ? LogLevel::info : LogLevel::warning);
  if (command.bind && !web::is_loopback(*command.bind) && !command.allow_remote)
    return refuse("the page at " + *command.bind +
                  " would be reachable from other machines; if intended, add --allow-remote: the connection is not "
                  "encrypted");
  const EndSignals signals;
  auto settings = settings_of(command);
  if (!settings) return refuse("the list of cells has errors");
  const SystemClock clock;
  auto wall = WallRun::start({*settings, !command.json, command.state}, clock);
  if (!wall) return refuse(wall.error().text());
  if (!command.json) {
    std::printf("the wall is at %s\n", (*wall)->url().c_str());
    std::fflush(stdout);
  }
  const double seconds = command.json && command.seconds <= 0 ? kListen_s : command.seconds;
  const int signal = signals.wait(seconds);
  if (command.json) std::printf("%s\n", (*wall)->site().whole_json().c_str());
  if (signal == 0 || is_ordinary_end(signal)) return kExitDone;
  wall->reset();
  return refuse("the wall was ended by " + signal_text(signal));
}

}  // namespace

void add_wall(cli::Command program, Action& action) {
  auto options = std::make_shared<WallCommand>();
  cli::Command sub = program.subcommand(
      "wall", "Serve one page for many cells, from the summaries that their gateways publish on DDS");
  sub.option("--cells", options->cells, "the list of cells, wall.toml; otherwise whatever is discovered");
  sub.option("--port", options->port, "port of the page, 8430 by default; 0: a free one").between(0, 65535);
  sub.option("--bind", options->bind, "numeric address at which the page listens, 127.0.0.1 by default");
  sub.flag("--allow-remote", options->allow_remote, "another --bind than loopback; the connection is not encrypted");
  sub.option("--domain", options->domain, "domain of DDS, 0 by default").between(0, 232);
  sub.option("--interface", options->interface_address, "address of this machine for DDS, 127.0.0.1 by default");
  sub.option("--state", options->state, "file that remembers over a restart which cells were there");
  sub.option("--for", options->seconds, "end after this many seconds").positive();
  sub.flag("--json", options->json, "no page: listen for 3 s, or as long as --for says, and print what was heard");
  sub.flag("--verbose", options->verbose, "log more");
  sub.footer(
      "Examples: cellmirror wall --cells wall.toml --interface 10.0.0.5 --state /var/lib/cellmirror/wall.json\n"
      "          cellmirror wall --json | jq '.tiles[].content | {cell, state, reasons}'\n"
      "It only shows: it has no token and sends no commands. The list of cells: docs/wall.md.");
  sub.when_named([options, &action] { action = [options] { return run_wall(*options); }; });
}

}  // namespace cellmirror::app
