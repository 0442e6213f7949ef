// The force worker as status shows it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "rt_core/dynamics/force_computation.hpp"
#include "rt_core/ports/force_state.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

// As of one moment.
struct ForceReport {
  bool active = false;  // some robot has masses, or there is a haptic device
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();
  std::shared_ptr<const ForceState> state;  // null: nothing was computed yet
  std::vector<dynamics::NotComputed> not_computed;
  std::uint64_t limit_warnings = 0;
  std::uint64_t skipped = 0;  // ticks for which nothing was computed because the computation took longer
  double rate_hz = 0;
  HistogramSnapshot visible_after;
  HistogramSnapshot compute;
};

}  // namespace cellmirror::app
