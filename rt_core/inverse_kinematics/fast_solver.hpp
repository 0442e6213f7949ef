// Method::fast: the tick's search from the present posture, then from others. Internal to the folder.
#pragma once

#include <memory>

#include "rt_core/inverse_kinematics/inverse_kinematics.hpp"

namespace cellmirror::inverse_kinematics {

[[nodiscard]] std::unique_ptr<Solver> make_fast_solver(const kinematics::Chain& chain, const Clock& clock);

}  // namespace cellmirror::inverse_kinematics
