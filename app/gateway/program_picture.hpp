// What status and page are shown of robot programs, as of one moment.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/gateway/program_recordings.hpp"
#include "scripts/programs/controller/controllers.hpp"

namespace cellmirror::app {

// Of one robot; what is off or 0 is left out.
struct SignalPicture {
  std::string robot;
  std::vector<std::size_t> inputs_on;
  std::vector<std::size_t> outputs_on;
  std::vector<std::pair<std::size_t, double>> analogue_inputs;
  std::vector<std::pair<std::size_t, double>> analogue_outputs;
};

// A program that is being loaded.
struct LoadPicture {
  std::string robot;
  std::string program;
};

struct ProgramsPicture {
  std::vector<program::ProgramStatus> programs;
  std::vector<LoadPicture> loading;
  std::optional<program::Deadlock> deadlock;
  std::vector<std::pair<std::string, std::uint32_t>> semaphores;
  std::vector<SignalPicture> signals;
  std::vector<RecordingPicture> recordings;
  std::uint64_t failures = 0;
  std::string last_failure;
};

}  // namespace cellmirror::app
