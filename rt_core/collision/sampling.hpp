// Finds out by trying many postures whether two bodies always or never touch.
#pragma once

#include <cstdint>

#include "rt_core/collision/mechanism.hpp"
#include "rt_core/collision/pairs.hpp"

namespace cellmirror::collision {

// Two links that came nearer than this once may touch in a posture that was not tried.
inline constexpr double kNeverMargin = 0.005;  // m
inline constexpr int kSampledPostures = 2000;  // at random within the ranges of the joints
inline constexpr int kRefinedPostures = 400;   // around the nearest of those

struct SampledFinding {
  PairState state = PairState::tested;  // tested, always or never
  double least = 0;                     // m; never: the smallest distance that was found
  int postures = 0;
};

// The same answer on every machine. `may_be_never`: else the first posture without a touch ends it.
[[nodiscard]] SampledFinding sample(const RelativeMotion& motion, const Body& a, const Body& b, bool may_be_never);

}  // namespace cellmirror::collision
