// Does the same work each millisecond and prints how long it took as JSON, in microseconds: what the machine, with what
// else runs on it, makes of a computation whose length never differs. The work goes over half a mebibyte of
// numbers, as the simulation of tissue does. trainer_bench.py runs it beside pictures.
//   rt_fixed_work SECONDS PRIORITY WORK_US
#include <fmt/core.h>
#include <time.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include "rt_core/base/time.hpp"
#include "rt_core/rt/cyclic_thread.hpp"

namespace {

using namespace cellmirror;

class FixedWork final : public Cycle {
 public:
  void run(const CycleContext&) CELL_RT override {
    for (std::size_t left = steps; left > 0; left -= std::min(left, kValues)) {
      const std::size_t count = std::min(left, kValues);
      for (std::size_t i = 0; i < count; ++i) values_[i] = 0.999 * values_[i] + 0.001;
    }
  }

  static constexpr std::size_t kValues = (std::size_t{1} << 19U) / sizeof(double);
  std::size_t steps = kValues;  // not while it runs

 private:
  std::vector<double> values_ = std::vector<double>(kValues, 0.0);
};

struct Measured {
  SchedulingOutcome scheduling;
  HistogramSnapshot taken;
};

Result<Measured> measure(FixedWork& work, int seconds, int priority) {
  CyclicThread thread(work, {.name = "work", .period = Nanoseconds{1'000'000}, .priority = priority});
  if (auto started = thread.start(); !started) return std::unexpected(started.error());
  const timespec duration{.tv_sec = seconds, .tv_nsec = 0};
  nanosleep(&duration, nullptr);
  thread.stop();
  return Measured{thread.scheduling(), thread.compute_time().snapshot()};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    fmt::print(stderr, "usage: rt_fixed_work SECONDS PRIORITY WORK_US\n");
    return 2;
  }
  const int priority = std::atoi(argv[2]);
  FixedWork work;
  // Twice a second to find out how much takes so long, in the median, beside what else runs.
  Result<Measured> measured = measure(work, 1, priority);
  for (int i = 0; i < 2 && measured; ++i) {
    const double median_us = 1e-3 * static_cast<double>(measured->taken.percentile(50).count());
    work.steps =
        static_cast<std::size_t>(static_cast<double>(work.steps) * std::atof(argv[3]) / std::max(median_us, 1.0));
    measured = measure(work, i == 0 ? 1 : std::atoi(argv[1]), priority);
  }
  if (!measured) {
    fmt::print(stderr, "{}\n", measured.error().text());
    return 1;
  }
  const auto us = [&](double percent) {
    return 1e-3 * static_cast<double>(measured->taken.percentile(percent).count());
  };
  fmt::print("{{\"scheduler\": \"{}\", \"priority\": {}, \"p50\": {:.1f}, \"p99\": {:.1f}, \"p999\": {:.1f}}}\n",
             measured->scheduling.scheduler, measured->scheduling.priority, us(50), us(99), us(99.9));
  return 0;
}
