// Method::automatic: closed form where there is one, else starts from the table of seeds. Internal to the folder.
#pragma once

#include <memory>

#include "rt_core/inverse_kinematics/inverse_kinematics.hpp"

namespace cellmirror::inverse_kinematics {

[[nodiscard]] std::unique_ptr<Solver> make_automatic_solver(const kinematics::Chain& chain, const Clock& clock);

}  // namespace cellmirror::inverse_kinematics
