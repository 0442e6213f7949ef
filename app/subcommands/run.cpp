// cellmirror run CELL.toml: the gateway until a signal ends it.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <functional>
#include <memory>
#include <optional>

#include "app/console/load_progress.hpp"
#include "app/gateway/gateway.hpp"
#include "app/subcommands/end_signals.hpp"
#include "app/subcommands/resource_limits.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/cell_file.hpp"
#include "config/command_line/command_line.hpp"
#include "ipc/service_manager/notifier.hpp"
#include "ipc/service_manager/service_watchdog.hpp"
#include "ipc/sysv/force_guard.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::app {

namespace {

constexpr int kNoPort = -1;  // not given

struct RunOptions {
  GatewayOptions gateway;
  std::string cell;
  std::string script;
  std::string state;
  double rate_hz = 0;
  double seconds = 0;  // 0: until a signal
  int port = kNoPort;
  bool no_web = false;
  bool headless = false;
  bool verbose = false;
};

// Empty where nobody could hear it. One byte by itself, so that it tears no line of the log.
std::function<void()> terminal_bell() {
  for (const int terminal : {STDERR_FILENO, STDOUT_FILENO}) {
    if (isatty(terminal) == 0) continue;
    return [terminal] { [[maybe_unused]] const ssize_t written = ::write(terminal, "\a", 1); };
  }
  return {};
}

// Of systemd, where it started this process.
ServiceNotifier service_notifier() {
  auto notifier = ServiceNotifier::take_from_environment();
  if (notifier) return *std::move(notifier);
  log_warning("service", "{}", notifier.error().text());
  return {};
}

void notify(const ServiceNotifier& service, const std::string& lines) {
  if (const auto sent = service.send(lines); !sent) log_warning("service", "{}", sent.error().text());
}

// The signal that ends it; 0: its time has passed.
int serve(const Gateway& gateway, const ServiceNotifier& service, const EndSignals& signals, double seconds) {
  std::printf("%s\n", gateway.greeting().c_str());
  std::fflush(stdout);
  notify(service, "READY=1\n" + status_line(gateway.greeting()));
  const ServiceWatchdog watchdog(service, [&gateway] { return gateway.ticks(); });
  const int signal = signals.wait(seconds);
  notify(service, "STOPPING=1\nSTATUS=ending");
  return signal;
}

int run(const RunOptions& options) {
  set_log_level(options.verbose ? LogLevel::info : LogLevel::warning);
  report_exhausted_resources();
  if (auto enough = check_resource_limits(); !enough) return refuse(enough.error().text());
  const ServiceNotifier service = service_notifier();
  // Before all threads: it forks, which only a process of one thread does safely.
  const auto guard = ForceGuard::start();
  if (!guard) log_warning("force-guard", "{}", guard.error().text());
  const EndSignals signals;
  GatewayOptions gateway_options = options.gateway;
  gateway_options.headless = options.headless;
  gateway_options.web = !options.no_web;
  if (options.port != kNoPort) gateway_options.port = options.port;
  gateway_options.cell_file = cell_file_of(options.cell);
  gateway_options.state = options.state;
  if (!options.script.empty()) gateway_options.startup_script = options.script;
  if (options.rate_hz > 0) gateway_options.rate_hz = options.rate_hz;
  gateway_options.bell = terminal_bell();
  gateway_options.guard = guard ? guard->get() : nullptr;
  std::optional<ProgressLine> line("files loaded");
  gateway_options.progress = load_progress(*line);
  auto gateway = Gateway::start(gateway_options);
  line.reset();
  if (!gateway) return refuse(gateway.error().text());
  const int signal = serve(**gateway, service, signals, options.seconds);
  if (signal == 0 || is_ordinary_end(signal)) return kExitDone;
  gateway->reset();
  return refuse(fmt::format("the gateway was ended by {}", signal_text(signal)));
}

}  // namespace

void add_run(cli::Command program, Action& action) {
  auto options = std::make_shared<RunOptions>();
  cli::Command sub = program.subcommand("run", "Start the gateway of a cell; Ctrl-C ends it");
  sub.option("cell,--cell", options->cell, "the cell file or its folder, e.g. config/cells/transfer_cell").required();
  sub.option("--script", options->script,
             "startup SCRIPT, instead of the cell file's own: any path, or a name in the scripts/ of the cell");
  sub.option("--for", options->seconds, "end after this many seconds").positive();
  sub.option("--rate", options->rate_hz, "periods of the loop per second, 100 to 4000").between(100.0, 4000.0);
  auto port = sub.option("--port", options->port, "port of the monitor page; 0: a free one").between(0, 65535);
  sub.flag("--no-web", options->no_web, "without the monitor page").excludes(port);
  sub.flag("--headless", options->headless, "without pictures");
  sub.option("--state", options->state,
             "folder for what is written: records, saved views, recorded programs; otherwise the cell folder");
  sub.option("--instance", options->gateway.instance, "name of this gateway where several run beside each other");
  sub.flag("--verbose", options->verbose, "log more");
  sub.footer("Example: cellmirror run config/cells/transfer_cell/cell.toml --for 60 --instance test");
  sub.when_named([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace cellmirror::app
