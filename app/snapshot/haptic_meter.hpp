// The latency of a haptic device: from its measurement to the force that answers it.
#pragma once

#include <atomic>
#include <cstdint>

#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

// Written by the tick, read by any thread.
struct HapticMeter {
  LatencyHistogram latency;               // device's time of a sample to its force in the memory
  std::atomic<std::uint64_t> samples{0};  // relaxed: a number for people
};

}  // namespace cellmirror::app
