// Where a search begins again. Internal to the folder.
#pragma once

#include <cstddef>

#include "rt_core/inverse_kinematics/ipopt_formulation.hpp"
#include "rt_core/inverse_kinematics/posture.hpp"

namespace cellmirror::inverse_kinematics {

// The most promising of 200 postures of the spread, others for each `round`: looking at one costs a thousandth of a
// descent.
[[nodiscard]] JointValues promising_start(const PostureSpread& spread, std::size_t round, PoseModel& model,
                                          const Problem& problem);

}  // namespace cellmirror::inverse_kinematics
