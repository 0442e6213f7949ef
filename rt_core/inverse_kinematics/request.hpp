// Validation of a request before any method begins. Internal to the folder.
#pragma once

#include "rt_core/inverse_kinematics/inverse_kinematics.hpp"

namespace cellmirror::inverse_kinematics {

// The first thing that is wrong with the request, or the request with its present posture clamped into the limits.
[[nodiscard]] Result<Request> checked(const Request& request, const kinematics::Chain& chain);

}  // namespace cellmirror::inverse_kinematics
