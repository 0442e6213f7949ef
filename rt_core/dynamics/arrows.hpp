// Arrows of forces and torques for the picture (SET_FORCE_ARROW, SET_FRC_ARR_SPECIAL), as data.
#pragma once

#include <vector>

#include "rt_core/ports/force_state.hpp"

namespace cellmirror::dynamics {

// Of every joint and TCP of `forces`, as `settings` chooses: a component along an axis of the joint's (TCP's) frame, or
// the resultant; with motors_only the part along the joint's axis, whatever component was chosen, and only torques of
// joints that turn and forces of joints that slide (manual 1.2.4). In the world, N and Nm; an arrow shorter than
// kShortestArrow is left out.
inline constexpr double kShortestArrow = 1e-9;  // N or Nm
[[nodiscard]] std::vector<ForceArrow> force_arrows(const ForceArrowSettings& settings, const ForceState& forces);

}  // namespace cellmirror::dynamics
