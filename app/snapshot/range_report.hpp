// The ranging worker as status shows it.
#pragma once

#include <cstdint>
#include <memory>

#include "app/snapshot/range_readings.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

// As of one moment.
struct RangeReport {
  std::shared_ptr<const RangeReadings> readings;  // null: nothing was computed yet
  std::uint64_t skipped = 0;
  double rate_hz = 0;
  HistogramSnapshot age;
  HistogramSnapshot compute;
};

}  // namespace cellmirror::app
