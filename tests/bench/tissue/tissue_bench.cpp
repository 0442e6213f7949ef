// A millisecond of soft tissue, and cuts.
#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "tests/bench/tissue/scenes.hpp"

namespace cellmirror::tissue_bench {
namespace {

using tissue_bodies::made;
using tissue_bodies::state_of;

void BM_Step(benchmark::State& state) {
  tissue::Body body = made(ball_of(static_cast<double>(state.range(0))));
  const TissueObjectState figures = state_of(body);
  for (auto _ : state) step(body, static_cast<int>(figures.substeps));
  state.counters["elements"] = figures.elements;
  state.counters["nodes"] = figures.nodes;
  state.counters["substeps"] = figures.substeps;
  state.counters["ns_per_element_and_substep"] =
      benchmark::Counter(1e-9 * figures.elements * figures.substeps,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(BM_Step)->Arg(1'000)->Arg(10'000)->Arg(16'000)->Unit(benchmark::kMicrosecond);

// Strokes of scissors: a blade of 12 mm advances by 3 mm, anywhere in the body.
void BM_Cut(benchmark::State& state) {
  tissue::Body body = made(ball_of(static_cast<double>(state.range(0))));
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    const double x = normal(random);
    const double y = normal(random);
    return Eigen::Vector3d(x, y, normal(random)).normalized();
  };
  int strokes = 0;
  std::size_t links = 0;
  for (auto _ : state) {
    tissue::BladeSweep blade;
    blade.along = 0.012 * direction();
    blade.across = 0.003 * direction();
    blade.corner = 0.03 * direction();
    links += body.cut(blade).links;
    if (++strokes % 200 == 0) {
      state.PauseTiming();
      body.reset();
      state.ResumeTiming();
    }
  }
  state.counters["links_per_stroke"] = static_cast<double>(links) / strokes;
}
BENCHMARK(BM_Cut)->Arg(16'000)->Unit(benchmark::kMicrosecond);

// The other method, on tetrahedra of the same size and number.
void BM_ImplicitCorotational(benchmark::State& state) {
  const int cubes = static_cast<int>(std::lround(std::cbrt(static_cast<double>(state.range(0)) / 6.0)));
  const tissue::TetraMesh mesh =
      tissue_bodies::box(Eigen::Vector3d::Constant(cubes * 0.8 * kElementSize_m), {cubes, cubes, cubes});
  std::vector<std::uint8_t> fixed;
  for (const Eigen::Vector3d& p : mesh.nodes) fixed.push_back(p.z() < 1e-6 ? 1 : 0);
  Corotational body(mesh.nodes, mesh.tetrahedra, {}, fixed);
  std::size_t iterations = 0;
  for (auto _ : state) iterations += static_cast<std::size_t>(body.step(tissue::kStep_s, kGravity));
  state.counters["elements"] = static_cast<double>(mesh.tetrahedra.size());
  state.counters["solver_iterations"] =
      benchmark::Counter(static_cast<double>(iterations), benchmark::Counter::kAvgIterations);
}
BENCHMARK(BM_ImplicitCorotational)->Arg(1'000)->Arg(10'000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace cellmirror::tissue_bench

BENCHMARK_MAIN();
