// sim_footswitch: simulates a foot that presses switches.
#include <fmt/format.h>

#include "sim_devices/base/process.hpp"
#include "sim_devices/footswitch/command_line.hpp"
#include "sim_devices/footswitch/switch_loop.hpp"

int main(int argc, char** argv) {
  using namespace cellmirror;
  const auto [exit_code, options] = sim::parse_foot_switch_command_line(argc, argv);
  if (exit_code) return *exit_code;
  sim::install_signal_handlers();
  auto loop = sim::SwitchLoop::make(options);
  if (!loop) {
    fmt::print(stderr, "sim_footswitch: {}\n", loop.error().text());
    return 1;
  }
  if (!(*loop)->run()) return 1;
  const std::string text = sim::to_json((*loop)->summary());
  if (options.json) {
    fmt::print("{}\n", text);
  } else if (!options.quiet) {
    fmt::print(stderr, "sim_footswitch: {}\n", text);
  }
  return 0;
}
