#include "hand.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::haptics::test_rig {

namespace {

using Eigen::Vector3d;

constexpr int kSubsteps = 40;

Vector3d quantised(const Vector3d& p, double step) {
  return step > 0 ? Vector3d((p / step).array().round() * step) : p;
}

}  // namespace

HandRun run_hand(Rig& rig, const HandParameters& hand, int ticks, const std::function<Vector3d(double)>& wanted) {
  HandRun run;
  Vector3d p = wanted(0);
  Vector3d v = Vector3d::Zero();
  Vector3d force = Vector3d::Zero();  // what the device's motors do in this period
  double energy = 0;
  double highest = -1e9;
  double lowest = 1e9;
  const double period = seconds(rig.period);
  for (int k = 0; k < ticks; ++k) {
    rig.tick(quantised(p, hand.encoder_step));
    const Vector3d next_force = rig.port.output.force_D;
    const Vector3d before = p;
    const double h = period / kSubsteps;
    for (int i = 0; i < kSubsteps; ++i) {
      const Vector3d target = wanted(period * k + h * i);
      v += h / hand.mass * (force + hand.stiffness * (target - p) - hand.damping * v);
      p += h * v;
    }
    energy -= force.dot(p - before);
    run.least_energy = std::min(run.least_energy, energy);
    run.largest_step = std::max(run.largest_step, (next_force - force).norm());
    force = next_force;
    run.largest_force = std::max(run.largest_force, force.norm());
    if (k >= ticks - ticks / 10) {
      highest = std::max(highest, p.z());
      lowest = std::min(lowest, p.z());
    }
  }
  run.peak_to_peak = highest - lowest;
  run.depth_at_end = (rig.state().x_proxy - p).norm();
  run.force_at_end = force.norm();
  run.faulted = rig.state().phase == HapticPhase::faulted;
  return run;
}

HandRun press_wall(const HapticSettings& settings, const HandParameters& hand, double depth, double duration) {
  Rig rig(gantry(settings));
  rig.model = model_of({plane(Vector3d::UnitZ(), 0.0, Vector3d::Zero())}, Vector3d::Zero());
  const double down = 0.01 + depth;
  return run_hand(rig, hand, static_cast<int>(duration / seconds(rig.period)), [&](double t) {
    // A tenth of a second of getting ready, then a move of a quarter of a second.
    const double share = std::clamp((t - 0.1) / 0.25, 0.0, 1.0);
    return Vector3d(0, 0, 0.01 - down * share * share * (3 - 2 * share));
  });
}

}  // namespace cellmirror::haptics::test_rig
