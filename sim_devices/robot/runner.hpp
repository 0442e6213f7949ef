// Runs simulated devices until the time limit or quit: one thread per device, and this one for commands.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rt_core/base/result.hpp"
#include "sim_devices/robot/control_server.hpp"
#include "sim_devices/robot/device.hpp"

namespace cellmirror::sim {

struct RunnerConfig {
  std::string kind;  // "cia402", "dds", ... for the report
  std::string program = "sim_robot";
  std::optional<double> seconds;  // none: until quit, SIGINT or SIGTERM
  std::vector<FaultSpec> faults;  // windows count from the start
  std::string control_path;       // empty: standard input only
  bool watch_standard_input = true;
  int priority = 0;  // > 0: SCHED_FIFO for the sending threads, where allowed
};

class Runner {
 public:
  // Fails where a fault does not fit the devices or the control path cannot be opened; nothing has been sent then.
  static Result<std::unique_ptr<Runner>> make(RunnerConfig config,
                                              std::vector<std::unique_ptr<SimulatedDevice>> devices);
  ~Runner();
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  // Returns when all is over.
  void run();
  // One JSON document without line ends; keys are described in docs/sim-devices.md.
  [[nodiscard]] std::string report() const;

 private:
  struct Seat;  // a device, its lock and its thread
  explicit Runner(RunnerConfig config);
  [[nodiscard]] std::string answer(std::string_view line);
  Result<std::string> execute(const ControlCommand& command);
  void work(Seat& seat);

  RunnerConfig config_;
  ControlServer control_;
  std::vector<std::unique_ptr<Seat>> seats_;
  SystemClock clock_;
  Timestamp started_;
  Timestamp ends_ = kNeverEnds;
  bool quit_ = false;
};

}  // namespace cellmirror::sim
