// Finds out whether two bodies never or always touch: first by trying many postures, which refutes most pairs quickly,
// then by a proof.
#pragma once

#include <string>

#include "rt_core/collision/mechanism.hpp"
#include "rt_core/collision/pairs.hpp"

namespace cellmirror::collision {

// A pair that stays this far apart is not tested.
inline constexpr double kNeverMargin = 0.005;  // m
inline constexpr int kSampledPostures = 2000;  // at random within the ranges of the joints
inline constexpr int kRefinedPostures = 400;   // around the nearest of those

struct PairFinding {
  PairState state = PairState::tested;  // tested, always or never
  std::string reason;                   // empty: tested, and nothing suggests otherwise
};

// The same answer on every machine. `may_be_never`: else the first posture without a touch ends it.
[[nodiscard]] PairFinding examine(const RelativeMotion& motion, const Body& a, const Body& b, bool may_be_never);

}  // namespace cellmirror::collision
