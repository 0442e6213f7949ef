// Robot programs as status and page show them, as of one moment.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scripts/programs/controller/controllers.hpp"

namespace cellmirror::app {

// Of one robot; what is off or 0 is left out.
struct SignalSnapshot {
  std::string robot;
  std::vector<std::size_t> inputs_on;
  std::vector<std::size_t> outputs_on;
  std::vector<std::pair<std::size_t, double>> analogue_inputs;
  std::vector<std::pair<std::size_t, double>> analogue_outputs;
};

// A program that is being loaded.
struct LoadSnapshot {
  std::string robot;
  std::string program;
};

// A teach file that is being recorded (TF_RECORD).
struct RecordingSnapshot {
  std::string robot;
  std::string program;
  std::string language;
  std::size_t points = 0;
};

struct ProgramsSnapshot {
  std::vector<program::ProgramStatus> programs;
  std::vector<LoadSnapshot> loading;
  std::optional<program::Deadlock> deadlock;
  std::vector<std::pair<std::string, std::uint32_t>> semaphores;
  std::vector<SignalSnapshot> signals;
  std::vector<RecordingSnapshot> recordings;
  std::uint64_t failures = 0;
  std::string last_failure;
};

}  // namespace cellmirror::app
