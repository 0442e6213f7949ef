// sim_camera_head: simulates the pan-tilt head of a camera.
#include <fmt/format.h>

#include <utility>
#include <vector>

#include "rt_core/base/log.hpp"
#include "sim_devices/camera/command_line.hpp"

int main(int argc, char** argv) {
  using namespace cellmirror;
  auto [exit_code, job] = sim::parse_camera_head_command_line(argc, argv);
  if (exit_code) return *exit_code;
  if (job.verbose) set_log_level(LogLevel::info);
  if (job.quiet) set_log_level(LogLevel::error);
  std::vector<std::unique_ptr<sim::SimulatedDevice>> devices;
  devices.push_back(std::move(job.head));
  auto runner = sim::Runner::make(std::move(job.runner), std::move(devices));
  if (!runner) {
    fmt::print(stderr, "sim_camera_head: {}\n", runner.error().text());
    return 1;
  }
  (*runner)->run();
  const std::string report = (*runner)->report();
  if (job.json) {
    fmt::print("{}\n", report);
  } else if (!job.quiet) {
    fmt::print(stderr, "sim_camera_head: {}\n", report);
  }
  return 0;
}
