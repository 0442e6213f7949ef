// The command line of sim_footswitch. Its names are a contract with scripts and tests.
#pragma once

#include <optional>

#include "sim_devices/footswitch/options.hpp"

namespace cellmirror::sim {

// exit_code is set where there is nothing to run: help was printed (0), or the arguments do not fit (2). Messages are
// printed here.
struct ParsedFootSwitch {
  std::optional<int> exit_code;
  FootSwitchOptions options;
};
[[nodiscard]] ParsedFootSwitch parse_foot_switch_command_line(int argc, const char* const* argv);

}  // namespace cellmirror::sim
