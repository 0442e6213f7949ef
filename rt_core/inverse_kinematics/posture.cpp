#include "rt_core/inverse_kinematics/posture.hpp"

#include <cmath>
#include <numbers>

namespace cellmirror::inverse_kinematics {

double distance(const kinematics::Chain& chain, const JointValues& a, const JointValues& b) {
  double sum = 0;
  for (std::size_t i = 0; i < chain.variable_count(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

JointValues nearest_turns(const kinematics::Chain& chain, const JointValues& q, const JointValues& present) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  JointValues nearest = q;
  if (!chain.plain()) return nearest;  // a mimic follows by a part of a turn
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    if (!chain.rotates(i)) continue;
    const double lower = chain.lower()[i];
    const double upper = chain.upper()[i];
    double value = q[i] + kTurn * std::round((present[i] - q[i]) / kTurn);
    if (value > upper) value -= kTurn * std::ceil((value - upper) / kTurn);
    if (value < lower) value += kTurn * std::ceil((lower - value) / kTurn);
    if (value >= lower && value <= upper) nearest[i] = value;
  }
  return nearest;
}

}  // namespace cellmirror::inverse_kinematics
