#include "rt_core/inverse_kinematics/posture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rt_core/kinematics/reach.hpp"

namespace cellmirror::inverse_kinematics {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

// A whole turn of the variable brings every joint that it moves back to where it was. A mimic of half the speed does
// not come back.
bool turns_are_equal(const kinematics::Chain& chain, std::size_t variable) {
  if (!chain.rotates(variable)) return false;
  if (chain.plain()) return true;
  for (const kinematics::ChainJoint& joint : chain.joints()) {
    if (joint.variable == variable && joint.multiplier != std::round(joint.multiplier)) return false;
  }
  return true;
}

// The ratio of the sequence: the root of x^(d+1) = x + 1.
double sequence_ratio(std::size_t dimensions) {
  double x = 2.0;
  for (int i = 0; i < 60; ++i) x = std::pow(1.0 + x, 1.0 / static_cast<double>(dimensions + 1));
  return x;
}

}  // namespace

double distance(const kinematics::Chain& chain, const JointValues& a, const JointValues& b) {
  double turning = 0;
  double sliding = 0;
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    (chain.rotates(i) ? turning : sliding) += (a[i] - b[i]) * (a[i] - b[i]);
  }
  if (sliding == 0) return std::sqrt(turning);
  const double unit = kinematics::unit_of_length(chain);
  return std::sqrt(turning + sliding / (unit * unit));
}

JointValues nearest_turns(const kinematics::Chain& chain, const JointValues& q, const JointValues& present) {
  constexpr double kRounding = 1e-6;  // rad, m: what a closed form may be off near a singular posture
  JointValues nearest = q;
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    const double lower = chain.lower()[i];
    const double upper = chain.upper()[i];
    double value = q[i];
    if (turns_are_equal(chain, i)) {
      value += kTurn * std::round((present[i] - value) / kTurn);
      if (value > upper + kRounding) value -= kTurn * std::ceil((value - upper - kRounding) / kTurn);
      if (value < lower - kRounding) value += kTurn * std::ceil((lower - value - kRounding) / kTurn);
    }
    if (value >= lower - kRounding && value <= upper + kRounding) nearest[i] = std::clamp(value, lower, upper);
  }
  return nearest;
}

Range sampling_range(const kinematics::Chain& chain, std::size_t variable) {
  const double lower = chain.lower()[variable];
  const double upper = chain.upper()[variable];
  if (!std::isfinite(lower)) return {-std::numbers::pi, kTurn};
  const bool more = upper - lower > kTurn && turns_are_equal(chain, variable);
  return more ? Range{0.5 * (lower + upper) - std::numbers::pi, kTurn} : Range{lower, upper - lower};
}

PostureSpread::PostureSpread(const kinematics::Chain& chain) : n_(chain.variable_count()) {
  const double ratio = sequence_ratio(n_);
  double step = 1.0;
  for (std::size_t i = 0; i < n_; ++i) {
    step /= ratio;
    step_[i] = step;
    range_[i] = sampling_range(chain, i);
  }
}

JointValues PostureSpread::at(std::size_t index) const {
  JointValues q{};
  for (std::size_t i = 0; i < n_; ++i) {
    const double place = 0.5 + step_[i] * static_cast<double>(index + 1);
    q[i] = range_[i].lower + range_[i].width * (place - std::floor(place));
  }
  return q;
}

}  // namespace cellmirror::inverse_kinematics
