// How contacts of a robot deepen with the motion of its joints.
#pragma once

#include <cstddef>

#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/collision/pairs.hpp"
#include "rt_core/ports/proximity_state.hpp"
#include "rt_core/ports/robot_contacts.hpp"

namespace cellmirror::collision {

// Of the contact between bodies at the nodes `a` and `b`, by the joints of the robot in `slot`: the Jacobian of the
// velocity of b's point against a's, along the normal from a to b, with the sign of a growing depth.
[[nodiscard]] DepthRates depth_rates(const CompiledCell& cell, const CellPoses& poses, std::int32_t a, std::int32_t b,
                                     const TouchingPair& contact, std::size_t slot);

// The contacts of the robot in `slot` that any of its joints deepens: their deepest points. Pairs without contact
// points
// (`TouchingPair::normal` zero) are left out. `table` and `poses` are those that `found` was computed with. Off the
// tick; no heap memory.
[[nodiscard]] RobotContacts robot_contacts(const CompiledCell& cell, const CellPoses& poses, const PairTable& table,
                                           const ProximityState& found, std::size_t slot);

}  // namespace cellmirror::collision
