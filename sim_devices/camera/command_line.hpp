// The command line of sim_camera_head. Its names are a contract with scripts and tests.
#pragma once

#include <memory>
#include <optional>

#include "sim_devices/camera/camera_head.hpp"
#include "sim_devices/robot/runner.hpp"

namespace cellmirror::sim {

struct CameraHeadJob {
  RunnerConfig runner;
  std::unique_ptr<CameraHead> head;
  bool json = false;
  bool quiet = false;
  bool verbose = false;
};

// exit_code is set where there is nothing to run: help was printed (0), the arguments do not fit (2), or the channel
// cannot be opened (1). Messages are printed here.
struct ParsedCameraHead {
  std::optional<int> exit_code;
  CameraHeadJob job;
};
[[nodiscard]] ParsedCameraHead parse_camera_head_command_line(int argc, const char* const* argv);

}  // namespace cellmirror::sim
