// Reads all range sensors of a cell for posture after posture and adds up what was seen.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "app/proximity/envelope.hpp"
#include "app/proximity/postures.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/geometry/solid.hpp"
#include "rt_core/ports/proximity_state.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

struct SensorTotals {
  std::uint64_t seen = 0;           // frames with a reading
  std::uint64_t in_blind_zone = 0;  // of these
  std::uint64_t in_doubt = 0;
  double smallest_m = 0;
  double largest_m = 0;
  std::uint64_t smallest_frame = 0;
  std::string smallest_object;  // its short name
  Envelope distances;
};

struct RangeTotals {
  std::uint64_t frames = 0;
  std::vector<SensorTotals> sensors;  // in the order of CompiledCell::sensors
  HistogramSnapshot times;            // of poses and readings of all sensors
};

using ReadingSink = std::function<void(std::uint64_t frame, std::span<const RangeReading> readings)>;

[[nodiscard]] Result<RangeTotals> run_range(const std::shared_ptr<const CompiledCell>& cell,
                                            const std::shared_ptr<geometry::SolidLibrary>& solids, Postures& postures,
                                            const ReadingSink& sink);

}  // namespace cellmirror::app
