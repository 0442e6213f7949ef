// The command line of sim_robot. Its names are a contract with scripts and tests.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "sim_devices/robot/device.hpp"
#include "sim_devices/robot/runner.hpp"

namespace cellmirror::sim {

// What the program is to do.
struct Job {
  RunnerConfig runner;
  std::vector<std::unique_ptr<SimulatedDevice>> devices;
  bool json = false;  // the report on standard output at the end
  bool quiet = false;
  bool verbose = false;
  double wait_for_reader_s = 0;
  std::function<int()> readers;  // DDS: matched now
};

// exit_code is set where there is nothing to run: help was printed (0), the arguments do not fit (2), or something that
// they name does not work (1). Messages are printed here.
struct ParsedCommandLine {
  std::optional<int> exit_code;
  Job job;
};
[[nodiscard]] ParsedCommandLine parse_command_line(int argc, const char* const* argv);

}  // namespace cellmirror::sim
