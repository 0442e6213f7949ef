// What the worker that simulates tissue publishes some fifty times a second: for status, page, messages and metrics.
#pragma once

#include <cstdint>
#include <string>

#include "rt_core/ports/tissue_state.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

// As of one moment.
struct TissueReport {
  TissueState state;
  double rate_hz = 0;               // steps in the last second
  std::uint64_t late_steps = 0;     // milliseconds of real time that were not simulated, because a step took longer
  HistogramSnapshot compute;        // of one step
  HistogramSnapshot pose_to_force;  // from the tick that had the posture to the force for it
  std::string simd;                 // instruction set of the element kernel
};

}  // namespace cellmirror::app
