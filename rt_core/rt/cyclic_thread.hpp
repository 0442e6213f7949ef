// A thread that runs a function once a period, in phase, and knows how well it does.
#pragma once

#include <pthread.h>
#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <semaphore>
#include <string>

#include "rt_core/base/real_time.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/rt/latency_histogram.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror {

// What a cycle is given.
struct CycleContext {
  Timestamp now;             // when the thread woke up; the one reading of the clock in this cycle
  Timestamp scheduled;       // the slot of this cycle: first slot + a whole number of periods
  std::uint64_t cycle = 0;   // number of this cycle, from 0; skipped slots have no number
  std::uint64_t missed = 0;  // slots skipped since the cycle before
  Nanoseconds period{0};
  Nanoseconds last_compute{0};  // how long the cycle before this one took; 0 in the first
};

// What is run.
class Cycle {
 public:
  virtual ~Cycle() = default;
  virtual void run(const CycleContext& context) CELL_RT = 0;
};

struct CyclicThreadOptions {
  std::string name = "cyclic";  // the thread's name, 15 bytes of it
  Nanoseconds period{1'000'000};
  RealTimePolicy policy = RealTimePolicy::prefer;
  int priority = 80;                                   // SCHED_FIFO, 1..99
  std::optional<int> cpu{};                            // bind the thread to this processor
  std::size_t stack_bytes = std::size_t{1024} * 1024;  // at least 256 KiB
};

// Counters of the kernel about one thread since its start. Several of them at two times show what happened between.
struct ThreadUsage {
  std::uint64_t voluntary_switches = 0;    // it waited: in a cyclic thread once a cycle, more is a lock or I/O
  std::uint64_t involuntary_switches = 0;  // something of higher priority took its place
  std::uint64_t minor_faults = 0;          // page faults that found the page in memory
  std::uint64_t major_faults = 0;          // page faults that had to read it from a disk
};
// The difference of two readings of the same thread, later - earlier.
[[nodiscard]] ThreadUsage operator-(const ThreadUsage& later, const ThreadUsage& earlier);
// Reads /proc/self/task/<tid>/. For another thread than the one that is watched; not for the tick.
[[nodiscard]] Result<ThreadUsage> thread_usage(pid_t tid);

// Slots lie on a fixed grid: first slot + n periods. The thread sleeps until the next slot by the monotonic clock's
// absolute time, so that nothing accumulates. Two things can go wrong, and neither shifts the grid:
// - it wakes up late by whole periods (the machine was busy): it runs at once, for the newest slot that has passed;
// - a cycle takes longer than its period: the slots that passed meanwhile are skipped and it sleeps until the next one.
//   It never runs two cycles without a sleep between them, so that it cannot take a processor for itself.
// The skipped slots are counted, and passed to the next cycle.
class CyclicThread {
 public:
  static constexpr Nanoseconds kShortestPeriod{250'000};    // 4 kHz
  static constexpr Nanoseconds kLongestPeriod{10'000'000};  // 100 Hz

  // `cycle` outlives the thread. Nothing runs yet.
  CyclicThread(Cycle& cycle, CyclicThreadOptions options);
  ~CyclicThread();  // stops
  CyclicThread(const CyclicThread&) = delete;
  CyclicThread& operator=(const CyclicThread&) = delete;

  // Starts the thread; returns when its scheduling is settled, shortly before the first cycle. Fails for a period or
  // stack out of range, where no thread can be made, and where policy is `require` and SCHED_FIFO is refused; nothing
  // runs then. start() and stop() belong to one thread. A stopped thread may be started again (cycle numbers and
  // counters start again, the histograms go on).
  [[nodiscard]] Result<void> start();
  // Lets the cycle that is running end, starts no other, and joins: takes at most a period and a cycle. May be called
  // when nothing runs; not from within the cycle.
  void stop();
  [[nodiscard]] bool running() const { return thread_.has_value(); }

  // What the last start() got; the same thread as start().
  [[nodiscard]] const SchedulingOutcome& scheduling() const { return scheduling_; }
  [[nodiscard]] const CyclicThreadOptions& options() const { return options_; }

  // Any thread, while it runs or after.
  [[nodiscard]] std::uint64_t cycles() const CELL_RT { return cycles_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t missed() const CELL_RT { return missed_.load(std::memory_order_relaxed); }
  // Cycles that took longer than until their next slot.
  [[nodiscard]] std::uint64_t overruns() const CELL_RT { return overruns_.load(std::memory_order_relaxed); }
  // Calls of malloc, free and the like from within cycles; counted only where AllocationGuard::armed().
  [[nodiscard]] std::uint64_t heap_calls() const CELL_RT { return heap_calls_.load(std::memory_order_relaxed); }
  // Woken - scheduled, of each wake-up (before slots are skipped, so that a late one shows in full).
  [[nodiscard]] LatencyHistogram& wakeup_latency() { return wakeup_latency_; }
  [[nodiscard]] const LatencyHistogram& wakeup_latency() const { return wakeup_latency_; }
  // From the wake-up to the end of the cycle.
  [[nodiscard]] LatencyHistogram& compute_time() { return compute_time_; }
  [[nodiscard]] const LatencyHistogram& compute_time() const { return compute_time_; }
  // The kernel's id of the thread; 0 where none runs.
  [[nodiscard]] pid_t tid() const CELL_RT { return tid_.load(std::memory_order_relaxed); }
  // The kernel's counters of the thread since its first cycle; fails where none runs. Not for the tick.
  [[nodiscard]] Result<ThreadUsage> usage() const;

 private:
  static void* thread_main(void* self);
  bool prepare();
  void loop(Timestamp first_slot) noexcept;

  Cycle& cycle_;
  CyclicThreadOptions options_;
  std::optional<pthread_t> thread_;
  SchedulingOutcome scheduling_;
  std::optional<Error> start_error_;  // written by the new thread before `ready_`
  ThreadUsage usage_at_start_;
  std::binary_semaphore ready_{0};  // the new thread is settled
  std::binary_semaphore go_{0};     // and may begin
  std::atomic<bool> stop_requested_{false};
  std::atomic<pid_t> tid_{0};
  std::atomic<std::uint64_t> cycles_{0};
  std::atomic<std::uint64_t> missed_{0};
  std::atomic<std::uint64_t> overruns_{0};
  std::atomic<std::uint64_t> heap_calls_{0};
  LatencyHistogram wakeup_latency_;
  LatencyHistogram compute_time_;
};

}  // namespace cellmirror
