// One joint that pursues a value which another one gives tick by tick, within its own limits (MASTER_SLAVE).
#pragma once

#include "rt_core/base/real_time.hpp"

namespace cellmirror::motion {

// rad or m, and their derivatives by s.
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

// The position at the end of the step. Where the limits allow it, this is the target, so that a joint with the limits
// of its master has no lag; else the joint approaches the target as fast as it can and still stop there. It brakes in
// time for the ends of its range. An end of the range counts more than the acceleration, where it was moved towards the
// joint.
[[nodiscard]] double pursue(const PursuitStep& step, const PursuitLimits& limits) CELL_RT;

// The same for a target that is not known any more: to rest.
[[nodiscard]] double brake(const PursuitStep& step, const PursuitLimits& limits) CELL_RT;

}  // namespace cellmirror::motion
