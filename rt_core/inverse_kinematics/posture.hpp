// Postures: how far apart they are, and which of the equal ones is the nearest. Internal to the folder.
#pragma once

#include "rt_core/kinematics/chain.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::inverse_kinematics {

// Root of the sum of squared joint differences (rad and m alike), as "nearest" means it.
[[nodiscard]] double distance(const kinematics::Chain& chain, const JointValues& a, const JointValues& b);

// The same posture of the tip with each turning joint moved by whole turns to where it is nearest to `present` within
// its limits.
[[nodiscard]] JointValues nearest_turns(const kinematics::Chain& chain, const JointValues& q,
                                        const JointValues& present);

}  // namespace cellmirror::inverse_kinematics
