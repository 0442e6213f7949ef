// How large an arm is.
#pragma once

#include "rt_core/base/real_time.hpp"
#include "rt_core/kinematics/chain.hpp"

namespace cellmirror::kinematics {

// m: the tip is never farther from the first joint's origin; no tight bound.
[[nodiscard]] double reach_bound(const Chain& chain) CELL_RT;

// m: what weighs as much as a radian in searches, so that arms of any size are searched alike.
[[nodiscard]] double unit_of_length(const Chain& chain) CELL_RT;

}  // namespace cellmirror::kinematics
