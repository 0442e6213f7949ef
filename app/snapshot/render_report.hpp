// The render service as status shows it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "rt_core/ports/renderer_counters.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

// The trace of a TCP (SMEAR).
struct TraceSummary {
  std::string robot;
  std::size_t points = 0;
  std::size_t frames = 0;
  double length_m = 0;  // of the curve
};

// As of one moment.
struct RenderReport {
  bool on = false;
  std::string renderer;  // its own name; empty: it was not needed yet
  std::string problem;   // why there are no pictures; empty: there is nothing wrong
  double rate_hz = 0;
  int width = 0;  // pixels, of a picture that names no size
  int height = 0;
  std::size_t streams = 0;
  std::uint64_t updates = 0;
  std::uint64_t drawn = 0;
  std::uint64_t unchanged = 0;  // drawings that were left out because nothing had changed
  std::uint64_t on_demand = 0;  // pictures and picks, of `drawn`
  std::uint64_t in_haste = 0;   // without anti-aliasing, of `drawn`: there was no time for it
  std::uint64_t failed = 0;
  RendererCounters counters;
  std::vector<TraceSummary> traces;
  HistogramSnapshot scene;   // how long it took to join the scene,
  HistogramSnapshot draw;    // to draw it,
  HistogramSnapshot encode;  // to encode it
  HistogramSnapshot age;     // of the posture shown, when the picture could be had
};

}  // namespace cellmirror::app
