// Runs an empty cycle on a CyclicThread and prints its wake-up latencies as JSON, in whole microseconds rounded down,
// as cyclictest counts them. bench_tick_latency.py runs it in turns with cyclictest.
//   rt_tick_latency SECONDS [PRIORITY] [PERIOD_US]
#include <fmt/core.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <memory>
#include <string>

#include "rt_core/rt/cyclic_thread.hpp"
#include "rt_core/rt/memory_lock.hpp"

namespace {

using namespace cellmirror;

class CountingCycle final : public Cycle {
 public:
  static constexpr std::size_t kBins = 20'000;  // us; the last bin holds what is longer

  void run(const CycleContext& context) CELL_RT override {
    const Nanoseconds late =
        context.now - context.scheduled + static_cast<std::int64_t>(context.missed) * context.period;
    const auto us = static_cast<std::size_t>(std::max<std::int64_t>(late.count() / 1000, 0));
    ++bins_[std::min(us, kBins - 1)];
  }
  // After the thread has stopped.
  [[nodiscard]] std::string bins_as_json() const {
    std::string text = "{";
    for (std::size_t us = 0; us < kBins; ++us) {
      if (bins_[us] != 0) {
        fmt::format_to(std::back_inserter(text), "{}\"{}\": {}", text.size() > 1 ? ", " : "", us, bins_[us]);
      }
    }
    return text + "}";
  }

 private:
  std::array<std::uint64_t, kBins> bins_{};
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: rt_tick_latency SECONDS [PRIORITY] [PERIOD_US]\n");
    return 2;
  }
  const int seconds = std::atoi(argv[1]);
  const int priority = argc > 2 ? std::atoi(argv[2]) : 80;
  const int period_us = argc > 3 ? std::atoi(argv[3]) : 1000;

  const MemoryLockOutcome memory = lock_memory(RealTimePolicy::prefer);
  const CpuLatencyRequest no_idle_states(0);  // cyclictest asks for the same
  const auto cycle = std::make_unique<CountingCycle>();
  CyclicThread thread(*cycle, {.name = "tick", .period = Nanoseconds{period_us * 1000}, .priority = priority});
  if (const auto started = thread.start(); !started) {
    fmt::print(stderr, "{}\n", started.error().text());
    return 1;
  }
  const timespec duration{.tv_sec = seconds, .tv_nsec = 0};
  nanosleep(&duration, nullptr);
  const ThreadUsage usage = thread.usage().value_or(ThreadUsage{});
  thread.stop();

  const auto us = [](Nanoseconds ns) { return 1e-3 * static_cast<double>(ns.count()); };
  const HistogramSnapshot compute = thread.compute_time().snapshot();
  fmt::print(
      "{{\"scheduler\": \"{}\", \"priority\": {}, \"memory_locked\": {}, \"cycles\": {}, \"missed\": {}, "
      "\"voluntary_switches\": {}, \"involuntary_switches\": {}, \"minor_faults\": {}, \"major_faults\": {}, "
      "\"compute_p99_us\": {:.3f}, \"wakeup_max_us\": {:.3f}, \"wakeup_us\": {}}}\n",
      thread.scheduling().scheduler, thread.scheduling().priority, memory.ok, thread.cycles(), thread.missed(),
      usage.voluntary_switches, usage.involuntary_switches, usage.minor_faults, usage.major_faults,
      us(compute.percentile(99)), us(thread.wakeup_latency().max()), cycle->bins_as_json());
  return 0;
}
