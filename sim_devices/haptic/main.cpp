// sim_haptic: simulates a haptic device and the hand that holds it.
#include <fmt/format.h>

#include <memory>

#include "sim_devices/base/process.hpp"
#include "sim_devices/haptic/command_line.hpp"
#include "sim_devices/haptic/haptic_device.hpp"
#include "sim_devices/haptic/watcher.hpp"

namespace {

using namespace cellmirror;

int print_summary(const sim::HapticOptions& options, const sim::HapticSummary& summary) {
  const std::string text = sim::to_json(summary);
  if (options.json) {
    fmt::print("{}\n", text);
  } else if (!options.quiet) {
    fmt::print(stderr, "sim_haptic: {}\n", text);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const auto [exit_code, options] = sim::parse_haptic_command_line(argc, argv);
  if (exit_code) return *exit_code;
  sim::install_signal_handlers();
  std::unique_ptr<sim::HapticLog> log;
  if (!options.log.empty()) {
    auto made = sim::HapticLog::make(options.log, sim::AxisLayout(options.axes));
    if (!made) {
      fmt::print(stderr, "sim_haptic: {}\n", made.error().text());
      return 1;
    }
    log = std::move(*made);
  }
  if (options.watch) {
    sim::HapticWatcher watcher(options, log.get());
    watcher.run();
    return print_summary(options, watcher.summary());
  }
  std::unique_ptr<sim::ControlFifo> control;
  if (!options.control.empty()) {
    auto opened = sim::ControlFifo::open(options.control);
    if (!opened) {
      fmt::print(stderr, "sim_haptic: {}\n", opened.error().text());
      return 1;
    }
    control = std::move(*opened);
  }
  sim::HapticLoop loop(options, log.get(), control.get());
  if (!loop.run()) return 1;
  return print_summary(options, loop.summary());
}
