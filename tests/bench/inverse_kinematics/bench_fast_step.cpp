// The step of the tick: seven joints follow a straight line, one millimetre and a few milliradians a step. What a tick
// pays is the time of one iteration of the benchmark.
#include <benchmark/benchmark.h>

#include <string>

#include "rt_core/kinematics/fast_step.hpp"
#include "rt_core/kinematics/forward.hpp"
#include "tests/bench/inverse_kinematics/arms.hpp"

namespace cellmirror {
namespace {

void path_step(benchmark::State& state, const std::string& name) {
  const auto arms = test_arms::unseen_arms();
  for (const test_arms::Arm& arm : arms) {
    if (arm.name != name) continue;
    const std::size_t n = arm.chain.variable_count();
    JointValues q = arm.chain.middle();
    for (std::size_t i = 0; i < n; ++i)
      q[i] += (i % 2 == 0 ? 0.1 : 0.2) * (arm.chain.upper()[i] - arm.chain.lower()[i]);
    const Pose X_B0 = kinematics::forward(arm.chain, {q.data(), n});
    int step = 0;
    int unsolved = 0;
    int iterations = 0;
    for (auto _ : state) {
      step = (step + 1) % 200;
      const double along = 0.001 * (step < 100 ? step : 200 - step);
      const Pose X_BG =
          Pose(Eigen::Translation3d(0, along, 0)) * X_B0 * Pose(Eigen::AngleAxisd(3 * along, Eigen::Vector3d::UnitX()));
      const auto result = kinematics::fast_solve(arm.chain, {}, X_BG, {q.data(), n}, {});
      unsolved += result.solved ? 0 : 1;
      iterations += result.iterations;
      benchmark::DoNotOptimize(q);
    }
    state.counters["unsolved"] = unsolved;
    state.counters["iterations"] =
        benchmark::Counter(static_cast<double>(iterations), benchmark::Counter::kAvgIterations);
  }
}

BENCHMARK_CAPTURE(path_step, puma560_6_joints, "puma560");
BENCHMARK_CAPTURE(path_step, iiwa14_7_joints, "iiwa14");
BENCHMARK_CAPTURE(path_step, offset_7_joints, "offset-7");

}  // namespace
}  // namespace cellmirror

BENCHMARK_MAIN();
