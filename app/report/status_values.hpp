// Values of the status document that several of its parts have (docs/status.md).
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "rt_core/base/microseconds.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

// s from `then` to `now`; null where `then` is not known.
inline nlohmann::json age_json(Timestamp now, Timestamp then) {
  return then.known() ? nlohmann::json(seconds(now - then)) : nlohmann::json(nullptr);
}

inline nlohmann::json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

// us: p50, p99, p999 and max.
inline nlohmann::json percentiles_us(const HistogramSnapshot& snapshot) {
  return {{"p50", microseconds(snapshot.percentile(50))},
          {"p99", microseconds(snapshot.percentile(99))},
          {"p999", microseconds(snapshot.percentile(99.9))},
          {"max", microseconds(snapshot.max())}};
}

}  // namespace cellmirror::app
