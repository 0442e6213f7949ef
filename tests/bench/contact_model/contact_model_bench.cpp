// How long a contact model takes on the phantom trainer cell, for instruments that touch: the times of single models.
#include <benchmark/benchmark.h>

#include <ctime>
#include <random>

#include "rt_core/haptics/proxy.hpp"
#include "tests/unit/contact_model/trainer.hpp"

namespace cellmirror::contact_model {
namespace {

using Eigen::Vector3d;

// Of the processor: what else runs on the machine does not count.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A hand that wanders through the organ at 0.1 m/s; the proxy slides over its surface.
void slide_over_the_organ(benchmark::State& state) {
  Trainer trainer;
  ContactFinder finder(trainer.left, {.reach_m = 0.006});  // as its cell file asks for
  finder.adopt(trainer.compiled, trainer.pairs);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  haptics::Proxy proxy;
  haptics::ContactModel model;
  Vector3d hand(0.0, 0.0, 0.10);
  Vector3d goal = hand;
  trainer.pose();
  trainer.move_tip(trainer.left, hand);
  trainer.pose();
  proxy.start(hand);
  std::vector<double> times;
  std::size_t constraints = 0;
  double least_reach = 1;
  for (auto _ : state) {
    const double start = thread_seconds();
    finder.find(trainer.poses, Timestamp{}, model);
    const double seconds = thread_seconds() - start;
    state.SetIterationTime(seconds);
    times.push_back(seconds);
    constraints += model.count;
    least_reach = std::min(least_reach, model.reach);
    if ((goal - hand).norm() < 1e-3) {
      goal = Vector3d(0.0, 0.01, 0.05) + Vector3d(0.05 * part(random), 0.04 * part(random), 0.025 * part(random));
    }
    hand += 1e-4 * (goal - hand).normalized();
    proxy.follow(&model, hand, {}, 3e-3);
    trainer.move_tip(trainer.left, proxy.x());
    trainer.pose();
  }
  std::ranges::sort(times);
  const auto quantile = [&times](double part_of) {
    return 1e6 * times[static_cast<std::size_t>(part_of * static_cast<double>(times.size() - 1))];
  };
  state.counters["p50_us"] = quantile(0.5);
  state.counters["p99_us"] = quantile(0.99);
  state.counters["max_us"] = quantile(1.0);
  state.counters["constraints"] = static_cast<double>(constraints) / static_cast<double>(times.size());
  state.counters["least_reach_mm"] = 1e3 * least_reach;
}
BENCHMARK(slide_over_the_organ)->UseManualTime()->Unit(benchmark::kMicrosecond)->Iterations(20000);

}  // namespace
}  // namespace cellmirror::contact_model

BENCHMARK_MAIN();
