// Time of one tick of one haptic channel, everything included: instrument of four joints through a trocar, sliding with
// friction over `planes` constraints.
#include <benchmark/benchmark.h>

#include <cmath>

#include "rig.hpp"

namespace cellmirror::haptics {
namespace {

using Eigen::Vector3d;

void step(benchmark::State& run) {
  HapticSettings settings;
  settings.X_WD.translation() = Vector3d(0, 0, -0.15);
  test_rig::Rig rig(test_rig::trocar(settings));
  const Vector3d x_ref(0, 0, -0.15);
  std::vector<ContactConstraint> planes;
  for (int i = 0; i < static_cast<int>(run.range(0)); ++i) {
    const double angle = 2.0 * i;
    planes.push_back(
        test_rig::plane(Vector3d(0.4 * std::cos(angle), 0.4 * std::sin(angle), 1).normalized(), -0.15, x_ref));
  }
  rig.model = test_rig::model_of(planes, x_ref);
  rig.q[2] = 0.15;
  rig.go({0, 0.01, 0.02}, 500);
  rig.go({0, 0.01, -0.004}, 500);
  double t = 0;
  for (auto _ : run) {
    t += 1e-3;
    rig.tick({0.01 * std::sin(t), 0.01 * std::cos(1.3 * t), -0.004});
  }
  if (rig.state().phase == HapticPhase::faulted) run.SkipWithError("the channel ended in a fault");
}
BENCHMARK(step)->ArgName("planes")->Arg(0)->Arg(1)->Arg(4)->Arg(12);

// The same in free space and in soft tissue that touches shaft and effector; a new response in each tick.
void step_in_tissue(benchmark::State& run) {
  HapticSettings settings;
  settings.X_WD.translation() = Vector3d(0, 0, -0.15);
  test_rig::Rig rig(test_rig::trocar(settings));
  rig.model = test_rig::model_of({}, Vector3d(0, 0, -0.15));
  rig.q[2] = 0.15;
  rig.show_tissue = true;
  rig.tissue.slot = rig.instrument.slot;
  rig.tissue.contacts = 4;
  rig.tissue.force_W = {0.1, 0.2, 0.6};
  rig.tissue.torque_W = {0.01, -0.005, 0.002};
  rig.tissue.stiffness << 80, 10, 0, 10, 90, 5, 0, 5, 150;
  rig.tissue_worker = [](test_rig::Rig& r) {
    ++r.tissue.sequence;
    r.tissue.posture_time = r.now;
    r.tissue.x_ref = r.state().x_proxy;
  };
  rig.go({0, 0.01, 0.02}, 500);
  double t = 0;
  for (auto _ : run) {
    t += 1e-3;
    rig.tick({0.01 * std::sin(t), 0.01 * std::cos(1.3 * t), 0.02});
  }
  if (rig.state().phase == HapticPhase::faulted) run.SkipWithError("the channel ended in a fault");
}
BENCHMARK(step_in_tissue);

}  // namespace
}  // namespace cellmirror::haptics

BENCHMARK_MAIN();
