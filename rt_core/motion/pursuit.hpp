// The next position of a joint that follows another joint within its own limits (MASTER_SLAVE, manual 1.2.4). One axis;
// tick thread; constant time.
#pragma once

#include "rt_core/base/real_time.hpp"

namespace cellmirror::motion {

// rad or m, and their derivatives by s. `lower` is at most `upper`.
struct PursuitLimits {
  double lower = 0;
  double upper = 0;
  double velocity = 0;
  double acceleration = 0;  // infinite: not given
};

struct PursuitStep {
  double present = 0;
  double velocity = 0;  // of the step before
  double target = 0;    // at the end of this step
  double target_velocity = 0;
  double dt = 0;  // s
};

// Returns the position at the end of the step. This is the target if the limits allow it, so that a joint with the
// limits of its master has no lag. Otherwise the joint approaches the target as fast as it can and still stop there.
// The joint brakes in time for the ends of its range; an end that was moved towards the joint overrides the
// acceleration.
[[nodiscard]] double pursue(const PursuitStep& step, const PursuitLimits& limits) CELL_RT;

// Returns the position at the end of a step that brakes the joint to rest, for a target that is no longer known.
[[nodiscard]] double brake(const PursuitStep& step, const PursuitLimits& limits) CELL_RT;

}  // namespace cellmirror::motion
