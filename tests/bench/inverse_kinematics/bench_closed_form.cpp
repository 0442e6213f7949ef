// Time of all postures of a target, over 1,000 targets from random postures. Mean of one target.
#include <benchmark/benchmark.h>

#include <array>
#include <vector>

#include "rt_core/inverse_kinematics/closed_form.hpp"
#include "rt_core/kinematics/forward.hpp"
#include "tests/unit/inverse_kinematics/closed_form_arms.hpp"

namespace cellmirror::inverse_kinematics {
namespace {

void all_postures(benchmark::State& state, const kinematics::Chain& chain) {
  const auto sut = chain.variable_count() == 7 ? ClosedForm::analyse_redundant(chain) : ClosedForm::analyse(chain);
  if (!sut) return state.SkipWithError("declined");
  constexpr std::size_t kTargets = 1000;
  test::Random random(1);
  std::vector<JointValues> postures;
  std::vector<Pose> targets;
  for (std::size_t i = 0; i < kTargets; ++i) {
    postures.push_back(random.posture());
    targets.push_back(kinematics::forward(chain, postures.back()));
  }
  std::array<JointValues, kMaxClosedForms> out;
  std::size_t k = 0;
  std::size_t found = 0;
  for (auto _ : state) {
    found += sut->solve(targets[k], out, postures[k]);
    k = (k + 1) % kTargets;
    benchmark::DoNotOptimize(out);
  }
  state.counters["postures"] = benchmark::Counter(static_cast<double>(found), benchmark::Counter::kAvgIterations);
}

void analyse(benchmark::State& state, const kinematics::Chain& chain) {
  for (auto _ : state) benchmark::DoNotOptimize(ClosedForm::analyse(chain));
}

kinematics::Chain of_family(test::Shoulder shoulder) {
  test::Random random(1);
  return test::chain_of_axes(test::wrist_arm(shoulder, random), random);
}

kinematics::Chain three_parallel() {
  test::Random random(1);
  return test::chain_of_axes(test::parallel_arm(false, random), random);
}

BENCHMARK_CAPTURE(all_postures, puma_560, test::puma_560());
BENCHMARK_CAPTURE(all_postures, manutec_r3, test::manutec_r3());
BENCHMARK_CAPTURE(all_postures, ur_5, test::ur_5());
BENCHMARK_CAPTURE(all_postures, wrist_axes_12_intersecting, of_family(test::Shoulder::intersecting_12));
BENCHMARK_CAPTURE(all_postures, wrist_alone, of_family(test::Shoulder::general));
BENCHMARK_CAPTURE(all_postures, three_parallel_alone, three_parallel());
BENCHMARK_CAPTURE(analyse, puma_560, test::puma_560());

}  // namespace
}  // namespace cellmirror::inverse_kinematics

BENCHMARK_MAIN();
