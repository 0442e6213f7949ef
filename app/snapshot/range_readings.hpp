// The readings of the ultrasonic sensors and light barriers, as the ranging worker publishes them.
#pragma once

#include <cstdint>
#include <vector>

#include "rt_core/base/time.hpp"
#include "rt_core/ports/light_barrier.hpp"
#include "rt_core/ports/proximity_state.hpp"

namespace cellmirror::app {

// The readings of all active sensors and all light barriers at one posture.
struct RangeReadings {
  std::uint64_t sequence = 0;  // counts from 1
  Timestamp posture_time;      // the tick's instant
  Timestamp finished;          // when the computation ended
  std::vector<RangeReading> readings;
  std::vector<BarrierReading> barriers;
};

}  // namespace cellmirror::app
