#include "rt_core/engine/plausibility_check.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::engine {

namespace {

PlausibilityVerdict implausible(Implausibility why, double value, double bound) CELL_RT {
  return {.shown = false, .why = why, .value = value, .bound = bound};
}

// To the last bit, but for the sign of zero.
bool equal(const StreamValue& a, const StreamValue& b) CELL_RT {
  return a.position == b.position && a.velocity == b.velocity && a.effort == b.effort;
}

}  // namespace

void PlausibilityCheck::begin(const PlausibilityBounds& bounds) CELL_RT {
  bounds_ = bounds;
  joints_ = {};
}

// A velocity is the least that explains the step: over all the time that the value before may have been older.
PlausibilityVerdict PlausibilityCheck::compare(const KnownLimits& bounds, const Joint& joint,
                                               const StreamValue& value) const CELL_RT {
  if (std::abs(value.velocity) > bounds.velocity)
    return implausible(Implausibility::velocity, value.velocity, bounds.velocity);
  if (!joint.last.receive_time.known()) return {};
  const Nanoseconds apart = std::max(value.receive_time - joint.last.receive_time, Nanoseconds(0));
  const double dt = seconds(apart + bounds_.arrival_jitter);
  const double step = value.position - joint.last.position;
  if (std::abs(step) > bounds.velocity * dt) return implausible(Implausibility::velocity, step / dt, bounds.velocity);
  const double change = value.velocity - joint.last.velocity;
  if (std::abs(change) > bounds.acceleration * dt)
    return implausible(Implausibility::acceleration, change / dt, bounds.acceleration);
  if (bounds_.frozen_after.count() > 0 && equal(value, joint.last) &&
      value.receive_time - joint.changed > bounds_.frozen_after)
    return implausible(Implausibility::frozen, seconds(value.receive_time - joint.changed),
                       seconds(bounds_.frozen_after));
  return {};
}

PlausibilityVerdict PlausibilityCheck::check(std::size_t joint, const StreamValue& value) CELL_RT {
  const KnownLimits& bounds = bounds_.joints[joint];
  Joint& known = joints_[joint];
  known.heard = value.receive_time;
  if (value.position < bounds.lower || value.position > bounds.upper) {
    known.doubt = bounds_.plausible_after;
    return implausible(Implausibility::position, value.position,
                       value.position < bounds.lower ? bounds.lower : bounds.upper);
  }
  PlausibilityVerdict verdict = compare(bounds, known, value);
  if (!known.last.receive_time.known() || !equal(value, known.last)) known.changed = value.receive_time;
  known.last = value;
  if (verdict.why != Implausibility::none) {
    known.doubt = bounds_.plausible_after;
  } else if (known.doubt > 0) {
    --known.doubt;
    verdict.shown = known.doubt == 0;
  }
  return verdict;
}

}  // namespace cellmirror::engine
