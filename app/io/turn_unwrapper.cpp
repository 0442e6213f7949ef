#include "app/io/turn_unwrapper.hpp"

#include <cmath>
#include <numbers>

namespace cellmirror::app {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kWithinATurn = kTurn * (1.0 + 1e-6);  // tolerates rounding in degrees or single precision

}  // namespace

bool TurnUnwrapper::push(const JointSample& sample) noexcept {
  if (sample.sequence == JointSample::kBeginsAnew) restart();
  if ((sample.present & joints_) == 0) return inner_->push(sample);
  JointSample out = sample;
  for (std::size_t i = 0; i < kMaxJointsPerRobot; ++i) {
    const double given = sample.position[i];
    if (((sample.present & joints_) >> i & 1U) == 0 || !std::isfinite(given)) continue;
    Joint& joint = joints_state_[i];
    if (std::abs(given) > kWithinATurn) {
      joint.turns = 0;
    } else if (joint.known && std::abs(joint.last) <= kWithinATurn) {
      joint.turns -= kTurn * std::round((given - joint.last) / kTurn);
    }
    joint.known = true;
    joint.last = given;
    out.position[i] = given + joint.turns;
  }
  return inner_->push(out);
}

}  // namespace cellmirror::app
