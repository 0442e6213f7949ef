// What a value costs on its way through a bounded queue of one producer and one consumer: ours, Boost.Lockfree's and
// (where the package libreaderwriterqueue-dev is installed) moodycamel's. Compare figures of one run only, with
//   rt_bench_queues --benchmark_repetitions=7 --benchmark_enable_random_interleaving=true
//                   --benchmark_report_aggregates_only=true
#include <benchmark/benchmark.h>
#include <malloc.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "rt_core/rt/fifo.hpp"

#if __has_include(<readerwriterqueue/readerwriterqueue.h>)
#include <readerwriterqueue/readerwriterqueue.h>
#define CELLMIRROR_HAS_READERWRITERQUEUE 1
#endif

namespace cellmirror {
namespace {

constexpr std::size_t kCapacity = 1023;  // moodycamel rounds up to a power of two, less one

template <std::size_t Words>
struct Value {
  std::array<std::uint64_t, Words> words{};
};
using Small = Value<1>;
using JointSampleSized = Value<52>;  // as large as a JointSample

template <class T>
struct Ours {
  Fifo<T, kCapacity> queue;
  bool push(const T& value) { return queue.push(value); }
  bool pop(T& value) { return queue.pop(value); }
};

template <class T>
struct Boost {
  boost::lockfree::spsc_queue<T, boost::lockfree::capacity<kCapacity>> queue;
  bool push(const T& value) { return queue.push(value); }
  bool pop(T& value) { return queue.pop(value); }
};

// Boost's with the statistics that a Fifo keeps, as a Fifo on top of it would be.
template <class T>
struct BoostCounting {
  boost::lockfree::spsc_queue<T, boost::lockfree::capacity<kCapacity>> queue;
  alignas(64) std::atomic<std::uint64_t> pushed{0};
  std::atomic<std::uint64_t> dropped{0};
  std::atomic<std::size_t> high_water{0};

  static void increment(std::atomic<std::uint64_t>& counter) {
    counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }
  bool push(const T& value) {
    if (!queue.push(value)) {
      increment(dropped);
      return false;
    }
    increment(pushed);
    const std::size_t level = kCapacity - queue.write_available();
    if (level > high_water.load(std::memory_order_relaxed)) {
      high_water.store(level, std::memory_order_relaxed);
    }
    return true;
  }
  bool pop(T& value) { return queue.pop(value); }
};

#ifdef CELLMIRROR_HAS_READERWRITERQUEUE
template <class T>
struct Moodycamel {
  moodycamel::ReaderWriterQueue<T, kCapacity + 1> queue{kCapacity};
  bool push(const T& value) { return queue.try_enqueue(value); }
  bool pop(T& value) { return queue.try_dequeue(value); }
};
#endif

// One thread: push and pop of one value; nothing moves between processors.
template <class Queue, class T>
void one_thread(benchmark::State& state) {
  const auto queue = std::make_unique<Queue>();
  T in{};
  T out{};
  for (auto _ : state) {
    in.words[0] += 1;
    benchmark::DoNotOptimize(queue->push(in));
    benchmark::DoNotOptimize(queue->pop(out));
    benchmark::DoNotOptimize(out);
  }
}

// Two threads, as fast as they can; real time a value. Whoever finds the queue full or empty gives its processor away.
template <class Queue, class T>
void two_threads(benchmark::State& state) {
  constexpr std::uint64_t kValues = 200'000;
  const auto queue = std::make_unique<Queue>();
  for (auto _ : state) {
    std::thread producer([&queue] {
      T in{};
      for (std::uint64_t n = 0; n < kValues; ++n) {
        in.words[0] = n;
        while (!queue->push(in)) {
          std::this_thread::yield();
        }
      }
    });
    T out{};
    for (std::uint64_t n = 0; n < kValues; ++n) {
      while (!queue->pop(out)) {
        std::this_thread::yield();
      }
      if (out.words[0] != n) {
        state.SkipWithError("a value was lost");
      }
    }
    producer.join();
  }
  state.counters["per_value"] =
      benchmark::Counter(kValues, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// One thread, the first pushes into a new queue: memory that was never written costs page faults.
template <class Queue, class T>
void first_round(benchmark::State& state) {
  mallopt(M_MMAP_THRESHOLD, 64 * 1024);  // each queue in pages of its own, fresh from the kernel
  long faults = 0;
  const T in{};
  for (auto _ : state) {
    state.PauseTiming();
    auto queue = std::make_unique<Queue>();
    rusage before{};
    getrusage(RUSAGE_THREAD, &before);
    state.ResumeTiming();
    for (std::size_t i = 0; i < kCapacity; ++i) {
      benchmark::DoNotOptimize(queue->push(in));
    }
    state.PauseTiming();
    rusage after{};
    getrusage(RUSAGE_THREAD, &after);
    faults += after.ru_minflt - before.ru_minflt;
    queue.reset();
    state.ResumeTiming();
  }
  state.counters["faults"] = benchmark::Counter(static_cast<double>(faults), benchmark::Counter::kAvgIterations);
}

// The least of the repetitions says what the code costs; the rest is what else the machine did.
double least(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }

#define CELLMIRROR_BENCH(function, Queue, T, name) \
  BENCHMARK(function<Queue<T>, T>)->Name(name)->UseRealTime()->ComputeStatistics("least", least)
#define CELLMIRROR_BENCH_QUEUE(Queue, name)                                             \
  CELLMIRROR_BENCH(one_thread, Queue, Small, "one_thread/8_bytes/" name);               \
  CELLMIRROR_BENCH(one_thread, Queue, JointSampleSized, "one_thread/416_bytes/" name);  \
  CELLMIRROR_BENCH(first_round, Queue, JointSampleSized, "first_1023/416_bytes/" name); \
  CELLMIRROR_BENCH(two_threads, Queue, Small, "two_threads/8_bytes/" name);             \
  CELLMIRROR_BENCH(two_threads, Queue, JointSampleSized, "two_threads/416_bytes/" name)

CELLMIRROR_BENCH_QUEUE(Ours, "ours");
CELLMIRROR_BENCH_QUEUE(Boost, "boost_raw");
CELLMIRROR_BENCH_QUEUE(BoostCounting, "boost_with_statistics");
#ifdef CELLMIRROR_HAS_READERWRITERQUEUE
CELLMIRROR_BENCH_QUEUE(Moodycamel, "moodycamel_raw");
#endif

}  // namespace
}  // namespace cellmirror

BENCHMARK_MAIN();
