// What is measured of a haptic device: the latency from its measurement to the force that answers it, and its samples.
#pragma once

#include <atomic>
#include <cstdint>

#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

// Written by the tick, read by any thread.
struct HapticMeter {
  LatencyHistogram latency;  // device's time of a sample to its force in the memory
  // Relaxed: numbers for people.
  std::atomic<std::uint64_t> samples{0};
  std::atomic<std::uint64_t> samples_per_second{0};
};

}  // namespace cellmirror::app
