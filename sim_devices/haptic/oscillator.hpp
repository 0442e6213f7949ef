// One axis of a hand: a mass held at a target by a spring and a damper. SI: m, N, kg or rad, Nm, kg m2.
#pragma once

namespace cellmirror::sim {

struct Impedance {
  double mass = 1;       // > 0
  double damping = 0;    // against the target's speed
  double stiffness = 0;  // 0: nothing holds it
};

struct OscillatorState {
  double x = 0;
  double v = 0;
};

struct AxisTarget {
  double x = 0;
  double v = 0;
};

// mass x" = stiffness (wish.x - x) + damping (wish.v - x') + effort, one Runge-Kutta step of fourth order. The target
// moves with its speed within the step, the effort is constant. Error of a step: of order (dt sqrt(k/m))^5.
[[nodiscard]] OscillatorState advance(const OscillatorState& state, const Impedance& impedance, const AxisTarget& wish,
                                      double effort, double dt);

}  // namespace cellmirror::sim
