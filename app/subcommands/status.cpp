// cellmirror status: what the running gateway does now.
#include <unistd.h>

#include <cstdio>
#include <ctime>
#include <memory>
#include <string>

#include "app/subcommands/status_table.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"
#include "ipc/control/control_client.hpp"
#include "ipc/control/instance.hpp"

namespace cellmirror::app {

namespace {

struct StatusOptions {
  bool json = false;
  bool watch = false;
  std::string instance{kDefaultInstance};
};

constexpr std::chrono::seconds kObserverTimeout{5};

// "name: what it is" for the other gateways that run, for the message about an unknown instance.
std::string others() {
  const auto running = running_instances();
  if (!running || running->empty()) return {};
  std::string out = "; running:";
  for (const InstanceInfo& info : *running) out += " " + info.name;
  return out;
}

int print_once(const StatusOptions& options) {
  const auto document = control_request(options.instance, R"({"request":"status"})", kObserverTimeout);
  if (!document) return refuse(document.error().text() + others());
  if (options.json) {
    std::printf("%s\n", document->c_str());
    return kExitDone;
  }
  const auto table = status_table(*document, isatty(STDOUT_FILENO) == 1);
  if (!table) return refuse(table.error().text());
  std::fputs(table->c_str(), stdout);
  return kExitDone;
}

int show(const StatusOptions& options) {
  if (!options.watch) return print_once(options);
  for (;;) {
    std::fputs("\x1b[H\x1b[2J", stdout);
    if (const int exit_code = print_once(options); exit_code != kExitDone) return exit_code;
    std::fflush(stdout);
    const timespec second{1, 0};
    nanosleep(&second, nullptr);
  }
}

}  // namespace

void add_status(cli::Command program, Action& action) {
  auto options = std::make_shared<StatusOptions>();
  cli::Command sub = program.subcommand("status", "Show what the running gateway does now");
  auto json = sub.flag("--json", options->json, "one JSON document (docs/status.md)");
  sub.flag("--watch", options->watch, "refresh every second until Ctrl-C").excludes(json);
  sub.option("--instance", options->instance, "name of the gateway").show_default();
  sub.footer("Example: cellmirror status --json | jq '.robots[] | {id, mode}'");
  sub.when_named([options, &action] { action = [options] { return show(*options); }; });
}

}  // namespace cellmirror::app
