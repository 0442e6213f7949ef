// The part of the status document about collisions and distances (docs/status.md).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/snapshot/collision_report.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json collisions_json(const CollisionReport& report, Timestamp now);

// {p50, p99, max} in units of `unit`; nulls where nothing was recorded. Also for ranges.
[[nodiscard]] nlohmann::json percentiles_json(const HistogramSnapshot& snapshot, Nanoseconds unit);

}  // namespace cellmirror::app
