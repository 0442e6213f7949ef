// The contact worker as status shows it.
#pragma once

#include <array>
#include <cstdint>

#include "rt_core/haptics/contact_model.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

// As of one moment.
struct ContactReport {
  std::uint64_t skipped = 0;  // ticks for which nothing was computed because the computation took longer
  double rate_hz = 0;
  HistogramSnapshot compute;        // of one tick's instruments together
  HistogramSnapshot visible_after;  // from a tick to the moment the tick can use what was found for it
  HistogramSnapshot adopting;       // how long nothing was found because the cell had changed
  std::array<haptics::ContactModel, kMaxHapticDevices> newest;
};

}  // namespace cellmirror::app
