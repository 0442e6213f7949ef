#include "rt_core/kinematics/reach.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::kinematics {

double reach_bound(const Chain& chain) CELL_RT {
  double reach = chain.X_LT().translation().norm();
  bool first = true;
  for (const ChainJoint& joint : chain.joints()) {
    if (!first) reach += joint.X_PJ.translation().norm();
    first = false;
    if (joint.kind != JointKind::prismatic) continue;
    const double lower = std::abs(joint.multiplier * chain.lower()[joint.variable] + joint.offset);
    const double upper = std::abs(joint.multiplier * chain.upper()[joint.variable] + joint.offset);
    reach += std::max(lower, upper);
  }
  return reach;
}

double unit_of_length(const Chain& chain) CELL_RT {
  constexpr double kShortest = 1e-3;  // m: a chain that only turns
  constexpr double kShare = 0.5;      // measured; flat around this value
  const double reach = reach_bound(chain);
  return reach > kShortest ? kShare * reach : 1.0;
}

}  // namespace cellmirror::kinematics
