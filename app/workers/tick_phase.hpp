// When a simulation with a clock of its own begins its steps: shortly behind the ticks whose postures it reads, so that
// a posture is not up to a period old before its step begins.
#pragma once

#include <algorithm>
#include <cstdint>

#include "rt_core/base/time.hpp"

namespace cellmirror::app {

// A tick publishes some 30 us after its time, on a busy machine later.
inline constexpr Nanoseconds kTickToStep{120'000};
inline constexpr Nanoseconds kMostPhaseChange{10'000};  // a step: the rate stays

// By how much more than a period the next step begins after this one, whose posture was so old when it began: 10 us at
// most. A tick may be a step's period, a multiple or a fraction of it; where it is none of these, the phase wanders as
// it would alone.
[[nodiscard]] inline Nanoseconds phase_change(Nanoseconds posture_age, Nanoseconds period) {
  std::int64_t behind = (posture_age.count() - kTickToStep.count()) % period.count();
  if (behind < 0) behind += period.count();
  if (behind > period.count() / 2) behind -= period.count();  // the next tick is nearer
  return Nanoseconds(std::clamp(-behind, -kMostPhaseChange.count(), kMostPhaseChange.count()));
}

}  // namespace cellmirror::app
