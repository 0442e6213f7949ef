#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <time.h>

#include <array>
#include <cstdlib>
#include <functional>
#include <semaphore>
#include <thread>

#include "rt_core/rt/allocation_guard.hpp"
#include "rt_core/rt/cyclic_thread.hpp"
#include "rt_core/rt/fifo.hpp"
#include "rt_core/rt/latest.hpp"
#include "rt_core/rt/memory_lock.hpp"
#include "rt_core/rt/ring.hpp"
#include "tests/unit/rt/in_child.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;

constexpr Nanoseconds kMs{1'000'000};
constexpr auto kPatience = std::chrono::seconds(30);  // only ever waited for by a test that fails

// What a cycle was told, and when it ended.
struct Seen {
  CycleContext context;
  Timestamp ended;
};

// Records each cycle; does something in it; says when enough were run.
class RecordingCycle final : public Cycle {
 public:
  static constexpr std::size_t kMost = 2000;

  RecordingCycle(std::size_t wanted, std::function<void(const CycleContext&)> work = {})
      : wanted_(wanted), work_(std::move(work)) {}

  void run(const CycleContext& context) CELL_RT override {
    if (work_) {
      work_(context);
    }
    if (count_ < kMost) {
      seen_[count_++] = Seen{context, SystemClock().now()};
      if (count_ == wanted_) {
        enough_.release();
      }
    }
  }

  bool wait() { return enough_.try_acquire_for(kPatience); }
  // After the thread has stopped.
  [[nodiscard]] std::span<const Seen> seen() const { return {seen_.data(), count_}; }

 private:
  std::size_t wanted_;
  std::function<void(const CycleContext&)> work_;
  std::array<Seen, kMost> seen_{};
  std::size_t count_ = 0;
  std::binary_semaphore enough_{0};
};

void compute_for(Nanoseconds duration) {
  const SystemClock clock;
  const Timestamp end = clock.now() + duration;
  while (clock.now() < end) {
  }
}

// What holds for every run, however late the machine wakes the thread.
void expect_grid_and_accounts(const RecordingCycle& cycle, const CyclicThread& sut) {
  const auto seen = cycle.seen();
  std::uint64_t missed = seen.front().context.missed;
  for (std::size_t i = 1; i < seen.size(); ++i) {
    const CycleContext& before = seen[i - 1].context;
    const CycleContext& now = seen[i].context;
    ASSERT_EQ(now.cycle, before.cycle + 1);
    ASSERT_EQ(now.scheduled - before.scheduled, static_cast<std::int64_t>(1 + now.missed) * now.period)
        << "the grid is kept and each skipped slot is told, cycle " << i;
    ASSERT_GE(now.now, now.scheduled) << "never early";
    ASSERT_LT(now.now - now.scheduled, now.period) << "always the newest slot that has passed";
    missed += now.missed;
  }
  EXPECT_EQ(sut.missed(), missed);
  EXPECT_EQ(sut.cycles(), seen.size());
  EXPECT_EQ(sut.wakeup_latency().count(), seen.size());
  EXPECT_EQ(sut.compute_time().count(), seen.size());
}

TEST(CyclicThread, RunsOnAGridOfWholePeriods) {
  RecordingCycle cycle(200);
  CyclicThread sut(cycle, {.name = "grid", .period = kMs, .priority = 20});
  ASSERT_TRUE(sut.start());
  ASSERT_TRUE(cycle.wait());
  sut.stop();
  EXPECT_EQ(cycle.seen().front().context.cycle, 0U);
  expect_grid_and_accounts(cycle, sut);
}

TEST(CyclicThread, AnOverrunKeepsThePhaseAndTellsTheNextCycleWhatWasMissed) {
  RecordingCycle cycle(30, [](const CycleContext& context) {
    if (context.cycle == 10) {
      compute_for(kMs * 7 / 2);  // 3.5 periods
    }
  });
  CyclicThread sut(cycle, {.name = "overrun", .period = kMs, .priority = 20});
  ASSERT_TRUE(sut.start());
  ASSERT_TRUE(cycle.wait());
  sut.stop();
  expect_grid_and_accounts(cycle, sut);
  EXPECT_GE(cycle.seen()[11].context.missed, 3U);
  EXPECT_GE(sut.overruns(), 1U);
  EXPECT_GE(sut.compute_time().max(), kMs * 7 / 2);
}

TEST(CyclicThread, SleepsBetweenAnyTwoCyclesEvenIfEachTakesTooLong) {
  RecordingCycle cycle(40, [](const CycleContext&) { compute_for(kMs * 6 / 5); });
  CyclicThread sut(cycle, {.name = "overload", .period = kMs, .priority = 20});
  ASSERT_TRUE(sut.start());
  ASSERT_TRUE(cycle.wait());
  sut.stop();
  expect_grid_and_accounts(cycle, sut);
  const auto seen = cycle.seen();
  for (std::size_t i = 1; i < seen.size(); ++i) {
    ASSERT_GT(seen[i].context.scheduled, seen[i - 1].ended) << "it ran for a slot that was over already";
  }
  EXPECT_EQ(sut.overruns(), seen.size());
}

TEST(CyclicThread, StopsBetweenCyclesAndMayBeStartedAgain) {
  RecordingCycle cycle(5);
  CyclicThread sut(cycle, {.name = "again", .period = CyclicThread::kLongestPeriod, .policy = RealTimePolicy::off});
  EXPECT_FALSE(sut.running());
  sut.stop();  // nothing runs
  ASSERT_TRUE(sut.start());
  EXPECT_TRUE(sut.running());
  EXPECT_NE(sut.tid(), 0);
  EXPECT_FALSE(sut.start()) << "it runs already";
  ASSERT_TRUE(cycle.wait());
  sut.stop();
  EXPECT_FALSE(sut.running());
  EXPECT_EQ(sut.tid(), 0);
  const std::size_t cycles = cycle.seen().size();
  ASSERT_TRUE(sut.start());
  sut.stop();
  EXPECT_LE(cycle.seen().size(), cycles + 1);
}

TEST(CyclicThread, APeriodOutOfRangeIsRefused) {
  RecordingCycle cycle(1);
  for (const Nanoseconds period : {Nanoseconds{0}, Nanoseconds{-1}, Nanoseconds{249'999}, Nanoseconds{10'000'001}}) {
    CyclicThread sut(cycle, {.period = period, .policy = RealTimePolicy::off});
    const auto started = sut.start();
    ASSERT_FALSE(started) << period.count();
    EXPECT_THAT(started.error().remedy, HasSubstr("100 Hz to 4000 Hz"));
    EXPECT_FALSE(sut.running());
  }
}

TEST(CyclicThread, AStackThatIsTooSmallIsRefused) {
  RecordingCycle cycle(1);
  CyclicThread sut(cycle, {.policy = RealTimePolicy::off, .stack_bytes = 1024});
  EXPECT_FALSE(sut.start());
}

TEST(CyclicThread, AProcessorThatDoesNotExistIsRefusedAndNothingRuns) {
  RecordingCycle cycle(1);
  CyclicThread sut(cycle, {.policy = RealTimePolicy::off, .cpu = 100'000});
  EXPECT_FALSE(sut.start());
  EXPECT_FALSE(sut.running());
  EXPECT_TRUE(cycle.seen().empty());
}

TEST(CyclicThread, RequiredButRefusedRealTimeDoesNotStart) {
  if (geteuid() != 0) {
    GTEST_SKIP() << "skipped: only root can become an ordinary user";
  }
#ifdef CELLMIRROR_SANITIZED
  GTEST_SKIP() << "skipped: threads after fork are not supported by the sanitizers";
#endif
  const std::string sut = in_child([] {
    if (!become_ordinary_user(0)) {
      return std::string("cannot become an ordinary user");
    }
    RecordingCycle cycle(1);
    CyclicThread required(cycle, {.policy = RealTimePolicy::require});
    const auto refused = required.start();
    CyclicThread preferred(cycle, {.policy = RealTimePolicy::prefer});
    const auto started = preferred.start();
    return (refused ? std::string("started") : refused.error().text()) + "|" + (started ? "started" : "refused") + "|" +
           preferred.scheduling().scheduler;
  });
  EXPECT_THAT(sut, HasSubstr("real-time scheduling is required"));
  EXPECT_THAT(sut, HasSubstr("CAP_SYS_NICE"));
  EXPECT_THAT(sut, testing::EndsWith("|started|SCHED_OTHER"));
}

TEST(CyclicThread, HeapCallsOfCyclesAreCounted) {
  ASSERT_TRUE(AllocationGuard::armed());
  RecordingCycle cycle(10, [](const CycleContext& context) {
    if (context.cycle == 4) {
      void* volatile block = std::malloc(100);
      std::free(block);
    }
  });
  CyclicThread sut(cycle, {.name = "heap", .period = kMs, .policy = RealTimePolicy::off});
  ASSERT_TRUE(sut.start());
  ASSERT_TRUE(cycle.wait());
  sut.stop();
  EXPECT_EQ(sut.heap_calls(), 2U);
}

// A cycle as the tick will be: takes from a Fifo, writes a Latest and a Ring.
struct Sample {
  std::array<double, 64> values{};
};
class BusyCycle final : public Cycle {
 public:
  void run(const CycleContext& context) CELL_RT override {
    Sample sample;
    sample.values[0] = static_cast<double>(context.cycle);
    fifo.push(sample);
    while (fifo.pop(sample)) {
      latest.writable() = sample;
      latest.publish();
      ring.push(sample);
    }
    if (context.cycle == 500) {
      enough.release();
    }
  }
  Fifo<Sample, 32> fifo;
  Latest<Sample> latest;
  Ring<Sample, 256> ring;
  std::binary_semaphore enough{0};
};

// In a child process, because it locks the memory. The kernel may move pages by itself now and then, so one round of
// three without page faults is enough; faults of the cycle's own would show in each.
TEST(CyclicThread, WithLockedMemoryACycleMeetsNoPageFaultNoLockAndNoHeap) {
#ifdef CELLMIRROR_SANITIZED
  GTEST_SKIP() << "skipped: sanitizers turn mlockall and the allocation guard off";
#endif
  if (const auto lock = probe_memory_lock(); !lock.ok) {
    GTEST_SKIP() << "skipped: " << lock.why_not;
  }
  const std::string outcome = in_child([] {
    if (!lock_memory(RealTimePolicy::require).ok) {
      return std::string("memory is not locked");
    }
    std::string answer;
    for (int round = 0; round < 3 && answer != "undisturbed"; ++round) {
      const auto cycle = std::make_unique<BusyCycle>();
      CyclicThread sut(*cycle, {.name = "busy", .period = kMs});
      if (!sut.start() || !cycle->enough.try_acquire_for(kPatience)) {
        return std::string("does not run");
      }
      const std::uint64_t cycles_before = sut.cycles();
      const auto usage = sut.usage();
      const std::uint64_t cycles = sut.cycles();
      sut.stop();
      if (!usage || sut.heap_calls() != 0 || !AllocationGuard::armed()) {
        return "heap calls: " + std::to_string(sut.heap_calls());
      }
      // Each cycle sleeps once, and once the thread waited for start(); fewer where a wake-up came late.
      if (usage->voluntary_switches > cycles + 3) {
        return std::to_string(usage->voluntary_switches) + " waits in " + std::to_string(cycles_before) + " cycles";
      }
      const std::uint64_t faults = usage->minor_faults + usage->major_faults;
      answer = faults == 0 ? "undisturbed" : std::to_string(faults) + " page faults";
    }
    return answer;
  });
  EXPECT_EQ(outcome, "undisturbed");
}

TEST(ThreadUsage, CountsTheWaitsOfAnotherThread) {
  std::binary_semaphore begin{0};
  std::binary_semaphore slept{0};
  std::binary_semaphore end{0};
  std::atomic<pid_t> tid{0};
  std::thread thread([&] {
    tid = thread_id();
    slept.release();
    begin.acquire();
    for (int i = 0; i < 50; ++i) {
      const timespec t{.tv_sec = 0, .tv_nsec = 100'000};
      nanosleep(&t, nullptr);
    }
    slept.release();
    end.acquire();
  });
  slept.acquire();
  const auto before = thread_usage(tid);
  begin.release();
  slept.acquire();
  const auto after = thread_usage(tid);
  end.release();
  thread.join();
  ASSERT_TRUE(before && after);
  // A sleep that is over before the processor was given up is no wait.
  EXPECT_GE((*after - *before).voluntary_switches, 40U);
}

TEST(ThreadUsage, OfAThreadThatIsNotThereFails) {
  const auto sut = thread_usage(1'000'000'000);
  ASSERT_FALSE(sut);
  EXPECT_THAT(sut.error().what, HasSubstr("1000000000"));
}

}  // namespace
}  // namespace cellmirror
