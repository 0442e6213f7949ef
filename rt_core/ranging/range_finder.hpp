// Reads the ultrasonic sensors and the light barriers of a cell. A sensor detects the active geometry except its own
// housing: geometry of bodies that are rigidly joined with it and contain or touch (within 1 mm) its apex. A light
// barrier likewise, with both ends of its beam.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "rt_core/base/time.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/geometry/solid.hpp"
#include "rt_core/ports/light_barrier.hpp"
#include "rt_core/ports/proximity_state.hpp"

namespace cellmirror::ranging {

enum class Selection : std::uint8_t { active_sensors, all_sensors };

class RangeFinder {
 public:
  explicit RangeFinder(std::shared_ptr<geometry::SolidLibrary> solids, std::vector<LightBarrier> barriers = {});
  ~RangeFinder();
  RangeFinder(const RangeFinder&) = delete;
  RangeFinder& operator=(const RangeFinder&) = delete;

  // The cell has changed. Off the tick; keeps the noise generators of sensors that stay.
  void adopt(std::shared_ptr<const CompiledCell> cell);
  // The readings at these poses of the adopted cell, in the order of CompiledCell::sensors. Valid until the next call.
  std::span<const RangeReading> read(const CellPoses& poses, Timestamp posture_time, Selection selection);
  // All light barriers, in their order, at the poses that the last read() had. Valid until the next call.
  std::span<const BarrierReading> read_barriers(const CellPoses& poses, Timestamp posture_time);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cellmirror::ranging
