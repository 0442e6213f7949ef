// sim_robot: simulates a robot controller.
#include <fmt/format.h>

#include <chrono>

#include "rt_core/base/log.hpp"
#include "sim_devices/base/pacer.hpp"
#include "sim_devices/robot/command_line.hpp"

namespace {

using namespace cellmirror;

void wait_for_reader(const sim::Job& job) {
  const SystemClock clock;
  const Timestamp until = clock.now() + Nanoseconds(static_cast<std::int64_t>(job.wait_for_reader_s * 1e9));
  while (job.readers && job.readers() == 0 && clock.now() < until) {
    sim::sleep_until(clock.now() + std::chrono::milliseconds(5));
  }
}

}  // namespace

int main(int argc, char** argv) {
  auto [exit_code, job] = sim::parse_command_line(argc, argv);
  if (exit_code) return *exit_code;
  if (job.verbose) set_log_level(LogLevel::info);
  if (job.quiet) set_log_level(LogLevel::error);
  wait_for_reader(job);
  auto runner = sim::Runner::make(std::move(job.runner), std::move(job.devices));
  if (!runner) {
    fmt::print(stderr, "sim_robot: {}\n", runner.error().text());
    return 1;
  }
  (*runner)->run();
  const std::string report = (*runner)->report();
  if (job.json) {
    fmt::print("{}\n", report);
  } else if (!job.quiet) {
    fmt::print(stderr, "sim_robot: {}\n", report);
  }
  return 0;
}
