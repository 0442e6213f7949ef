// Foot switches as status shows them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "rt_core/base/time.hpp"
#include "rt_core/rt/latency_histogram.hpp"
#include "scripts/runner/input_scripts.hpp"

namespace cellmirror::app {

// One change of an input, from 1. `time`: when it was seen first.
struct FootSwitchChange {
  std::uint32_t input = 0;
  bool on = false;
  Timestamp time;
};

struct FootSwitchSnapshot {
  std::int32_t key = 0;  // 0: no memory was named
  std::size_t bytes = 0;
  std::size_t inputs = 0;
  bool online = false;
  double debounce_s = 0;
  std::vector<std::uint32_t> inputs_on;  // while online; the first of them
  std::uint64_t edges = 0;               // since the start, as all counts
  std::uint64_t bounces = 0;
  std::uint64_t edges_dropped = 0;
  std::size_t waiting = 0;
  script::InputScripts::Counters scripts;
  script::InputScripts::Last last;
  std::vector<std::string> missing_files;  // the first of them
  std::uint64_t attached = 0;              // by others
  std::int32_t last_process = 0;
  std::uint64_t renewed = 0;
  std::string trouble;  // the memory was lost and could not be created again
  HistogramSnapshot first_command;
};

}  // namespace cellmirror::app
