#include "sim_devices/haptic/hand.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim_devices/base/random.hpp"

namespace cellmirror::sim {
namespace {

Impedance turned(const Impedance& linear, double arm) {
  const double factor = arm * arm;
  return {linear.mass * factor, linear.damping * factor, linear.stiffness * factor};
}

// The share of the wrist that the device alone has, as with the straight axes.
Impedance wrist_let_go(const HandParameters& p) {
  return {p.wrist.mass * p.released.mass / p.held.mass,
          p.wrist.damping * p.released.damping / std::max(p.held.damping, 1e-9), 0};
}

}  // namespace

Hand::Hand(const AxisLayout& layout, const HandParameters& parameters, const Coordinates& start)
    : axes_(layout.count()), x_(start) {
  Random random(parameters.seed);
  for (std::size_t axis = 0; axis < axes_; ++axis) {
    const bool on_arm = layout.is_trocar() && axis < 2;
    const bool straight = layout.kind(axis) == AxisKind::length;
    held_[axis] = straight ? parameters.held : on_arm ? turned(parameters.held, parameters.arm) : parameters.wrist;
    released_[axis] = straight ? parameters.released
                      : on_arm ? turned(parameters.released, parameters.arm)
                               : wrist_let_go(parameters);
    amplitude_[axis] = layout.kind(axis) == AxisKind::gripper ? 0
                       : straight                             ? parameters.tremor
                                                              : parameters.tremor / parameters.arm;
    for (Tone& tone : tones_[axis]) {
      const double hz =
          parameters.tremor_low_hz + (parameters.tremor_high_hz - parameters.tremor_low_hz) * random.fraction();
      tone = {2 * std::numbers::pi * hz, 2 * std::numbers::pi * random.fraction()};
    }
  }
}

double Hand::tremor(std::size_t axis, double t) const {
  double sum = 0;
  for (const Tone& tone : tones_[axis]) sum += std::sin(tone.omega * t + tone.phase);
  return amplitude_[axis] * sum / kTones;
}

void Hand::step(const Coordinates& wish, const Coordinates& wish_rate, const Coordinates& efforts, bool holding,
                double dt) {
  const auto steps = static_cast<int>(std::clamp(std::ceil(dt / kLongestStep - 1e-9), 1.0, 1000.0));
  const double h = dt / steps;
  for (int i = 0; i < steps; ++i) {
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      const double wished = wish[axis] + wish_rate[axis] * h * i + (amplitude_[axis] > 0 ? tremor(axis, t_) : 0);
      const OscillatorState next = advance({x_[axis], v_[axis]}, holding ? held_[axis] : released_[axis],
                                           {wished, holding ? wish_rate[axis] : 0}, efforts[axis], h);
      work_ += efforts[axis] * (next.x - x_[axis]);
      x_[axis] = next.x;
      v_[axis] = next.v;
    }
    t_ += h;
  }
}

}  // namespace cellmirror::sim
