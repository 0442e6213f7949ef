// Poses that can be reached, for measuring.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/kinematics/chain.hpp"

namespace cellmirror::app {

// The tip at random joint values, each uniform within its limits (continuous joints: -pi to pi). The same seed gives
// the same targets on every machine: 53 bits of one std::mt19937_64 a value, in the order of the joints.
[[nodiscard]] std::vector<Pose> reachable_targets(const kinematics::Chain& chain, std::size_t count,
                                                  std::uint64_t seed);

}  // namespace cellmirror::app
