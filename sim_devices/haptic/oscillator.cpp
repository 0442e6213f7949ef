#include "sim_devices/haptic/oscillator.hpp"

namespace cellmirror::sim {
namespace {

struct Slope {
  double v;
  double a;
};

Slope slope(const OscillatorState& s, const Impedance& impedance, const AxisTarget& wish, double effort, double t) {
  const double spring = impedance.stiffness * (wish.x + wish.v * t - s.x);
  const double damper = impedance.damping * (wish.v - s.v);
  return {s.v, (spring + damper + effort) / impedance.mass};
}

OscillatorState moved(const OscillatorState& s, const Slope& k, double dt) { return {s.x + k.v * dt, s.v + k.a * dt}; }

}  // namespace

OscillatorState advance(const OscillatorState& state, const Impedance& impedance, const AxisTarget& wish, double effort,
                        double dt) {
  const Slope k1 = slope(state, impedance, wish, effort, 0);
  const Slope k2 = slope(moved(state, k1, dt / 2), impedance, wish, effort, dt / 2);
  const Slope k3 = slope(moved(state, k2, dt / 2), impedance, wish, effort, dt / 2);
  const Slope k4 = slope(moved(state, k3, dt), impedance, wish, effort, dt);
  return {state.x + dt / 6 * (k1.v + 2 * k2.v + 2 * k3.v + k4.v),
          state.v + dt / 6 * (k1.a + 2 * k2.a + 2 * k3.a + k4.a)};
}

}  // namespace cellmirror::sim
