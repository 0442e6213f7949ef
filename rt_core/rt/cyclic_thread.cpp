#include "rt_core/rt/cyclic_thread.hpp"

#include <fmt/core.h>
#include <sys/prctl.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "rt_core/rt/allocation_guard.hpp"
#include "rt_core/rt/memory_lock.hpp"

namespace cellmirror {

namespace {

constexpr std::size_t kSmallestStack = 2 * kStackPrefault;

// The system's clock directly: the thread sleeps by it, so no other clock could be meant.
Timestamp monotonic_now() noexcept {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return Timestamp{t.tv_sec * 1'000'000'000 + t.tv_nsec};
}

void sleep_until(Timestamp instant) noexcept {
  const timespec t{.tv_sec = instant.ns / 1'000'000'000, .tv_nsec = instant.ns % 1'000'000'000};
  // Returns the error; EINTR: a signal, the instant still stands.
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

// One writer: a plain load and store saves the locked instruction. Relaxed: it publishes nothing but itself.
void add(std::atomic<std::uint64_t>& counter, std::uint64_t value) noexcept {
  counter.store(counter.load(std::memory_order_relaxed) + value, std::memory_order_relaxed);
}

}  // namespace

CyclicThread::CyclicThread(Cycle& cycle, CyclicThreadOptions options) : cycle_(cycle), options_(std::move(options)) {}

CyclicThread::~CyclicThread() { stop(); }

Result<void> CyclicThread::start() {
  if (running()) {
    return fail(fmt::format("the thread {} runs already", options_.name));
  }
  if (options_.period < kShortestPeriod || options_.period > kLongestPeriod) {
    return fail(fmt::format("a period of {} us is out of range", options_.period.count() / 1000),
                "choose a rate from 100 Hz to 4000 Hz");
  }
  if (options_.stack_bytes < kSmallestStack) {
    return fail(fmt::format("a stack of {} bytes is too small", options_.stack_bytes),
                fmt::format("give it at least {}", kSmallestStack));
  }
  stop_requested_.store(false, std::memory_order_relaxed);
  for (auto* counter : {&cycles_, &missed_, &overruns_, &heap_calls_}) {
    counter->store(0, std::memory_order_relaxed);
  }
  start_error_.reset();

  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  int error = pthread_attr_setstacksize(&attributes, options_.stack_bytes);
  pthread_t thread{};
  if (error == 0) {
    error = pthread_create(&thread, &attributes, &CyclicThread::thread_main, this);
  }
  pthread_attr_destroy(&attributes);
  if (error != 0) {
    return fail(fmt::format("the thread {} cannot be made: {}", options_.name, std::strerror(error)),
                "see `ulimit -u` and the free memory");
  }
  ready_.acquire();
  if (start_error_) {
    pthread_join(thread, nullptr);
    return std::unexpected(*start_error_);
  }
  usage_at_start_ = thread_usage(tid()).value_or(ThreadUsage{});
  thread_ = thread;
  go_.release();
  return {};
}

void CyclicThread::stop() {
  if (!thread_) {
    return;
  }
  stop_requested_.store(true, std::memory_order_relaxed);
  pthread_join(*thread_, nullptr);
  thread_.reset();
  tid_.store(0, std::memory_order_relaxed);
}

Result<ThreadUsage> CyclicThread::usage() const {
  const pid_t id = tid();
  if (id == 0) {
    return fail(fmt::format("the thread {} does not run", options_.name));
  }
  const Result<ThreadUsage> now = thread_usage(id);
  if (!now) {
    return now;
  }
  return *now - usage_at_start_;
}

void* CyclicThread::thread_main(void* self) {
  auto& thread = *static_cast<CyclicThread*>(self);
  if (thread.prepare()) {
    thread.ready_.release();
    thread.go_.acquire();
    thread.loop(monotonic_now() + thread.options_.period);
  } else {
    thread.ready_.release();
  }
  return nullptr;
}

// On the new thread, before the loop: may allocate and call the system.
bool CyclicThread::prepare() {
  set_thread_name(options_.name);
  tid_.store(thread_id(), std::memory_order_relaxed);
  // Without SCHED_FIFO the kernel may let timers expire 50 us late to gather them, prctl(2); 1 ns: it must not.
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  scheduling_ = set_real_time_scheduling(options_.policy, options_.priority);
  if (const auto enforced = enforce(options_.policy, scheduling_); !enforced) {
    start_error_ = enforced.error();
  } else if (options_.cpu) {
    if (const auto bound = set_cpu_affinity(*options_.cpu); !bound) {
      start_error_ = bound.error();
    }
  }
  prefault_stack();
  // The first reading of the clock maps the kernel's time page, which mlockall cannot do.
  static_cast<void>(monotonic_now());
  if (start_error_) {
    tid_.store(0, std::memory_order_relaxed);
  }
  return !start_error_;
}

void CyclicThread::loop(Timestamp first_slot) noexcept {
  const Nanoseconds period = options_.period;
  Timestamp slot = first_slot;
  std::uint64_t skipped = 0;  // since the last cycle
  Nanoseconds last_compute{0};
  for (std::uint64_t number = 0;; ++number) {
    sleep_until(slot);
    // Relaxed: stop() joins, nothing else is ordered by the flag.
    if (stop_requested_.load(std::memory_order_relaxed)) {
      return;
    }
    const Timestamp woken = monotonic_now();
    const Nanoseconds late = woken - slot;
    wakeup_latency_.record(late);
    const std::int64_t passed = late / period;  // whole periods slept through
    slot = slot + passed * period;
    skipped += static_cast<std::uint64_t>(passed);
    add(missed_, skipped);

    {
      const AllocationGuard guard;
      cycle_.run(CycleContext{.now = woken,
                              .scheduled = slot,
                              .cycle = number,
                              .missed = skipped,
                              .period = period,
                              .last_compute = last_compute});
      add(heap_calls_, guard.allocations() + guard.frees());
    }
    add(cycles_, 1);
    const Timestamp done = monotonic_now();
    last_compute = done - woken;
    compute_time_.record(last_compute);

    skipped = 0;
    slot = slot + period;
    if (done >= slot) {
      // On to the first slot that lies ahead, so that there is a sleep between any two cycles.
      const std::int64_t taken = (done - slot) / period + 1;
      slot = slot + taken * period;
      skipped = static_cast<std::uint64_t>(taken);
      add(overruns_, 1);
    }
  }
}

}  // namespace cellmirror
