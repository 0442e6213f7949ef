// The collision worker as status shows it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rt_core/collision/checker.hpp"
#include "rt_core/collision/pairs.hpp"
#include "rt_core/ports/proximity_state.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

// As of one moment.
struct CollisionReport {
  static constexpr std::size_t kEvents = 32;

  bool active = false;
  double warning_distance_m = 0;
  std::string note;                                   // for people; empty: there is nothing special
  std::shared_ptr<const ProximityState> state;        // null: nothing was computed yet
  std::shared_ptr<const collision::PairTable> pairs;  // null: not derived yet
  collision::CheckCounters counters;
  std::vector<ProximityEvent> events;  // the newest, oldest first
  std::uint64_t skipped = 0;           // ticks for which nothing was computed because the computation took longer
  double rate_hz = 0;
  HistogramSnapshot age;  // at which results were replaced by newer ones: none was read at a greater age
  HistogramSnapshot visible_after;
  HistogramSnapshot compute;
};

}  // namespace cellmirror::app
