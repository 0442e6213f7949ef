// The edge between two threads where every value counts: a bounded queue that refuses when it is full.
#pragma once

#include <algorithm>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "rt_core/base/real_time.hpp"

namespace cellmirror {

// First in, first out, one producer thread, one consumer thread; wait-free on both sides. A push into a full queue is
// refused and counted, what is already inside stays. All memory is inside the object (Capacity * sizeof(T)): put large
// ones on the heap as part of their owner, never on a stack. docs/decisions/0002-queues.md says why it is built on
// Boost.Lockfree.
//
// The producer's and the consumer's role may move to another thread where something else orders the two (a join, a
// lock); two threads in one role at the same time are a bug that this class cannot see.
template <class T, std::size_t Capacity>
class Fifo {
  static_assert(Capacity > 0);
  static_assert(std::is_trivially_copyable_v<T>, "values cross threads on the tick: no heap, no destructor");

 public:
  Fifo() = default;
  Fifo(const Fifo&) = delete;
  Fifo& operator=(const Fifo&) = delete;

  // Producer. False where the queue was full: the value was dropped and counted.
  bool push(const T& value) CELL_RT {
    if (!queue_.push(value)) {
      increment(dropped_);
      return false;
    }
    increment(pushed_);
    // From the producer's side the fill level can only be overestimated by what the consumer takes meanwhile.
    const std::size_t filled = Capacity - queue_.write_available();
    if (filled > high_water_.load(std::memory_order_relaxed)) {
      high_water_.store(filled, std::memory_order_relaxed);
    }
    return true;
  }

  // Consumer. False where the queue was empty; `value` is untouched then.
  bool pop(T& value) CELL_RT { return queue_.pop(value); }

  // Consumer. How many values can be popped now; more may arrive at any moment.
  [[nodiscard]] std::size_t size() const CELL_RT { return queue_.read_available(); }
  [[nodiscard]] static constexpr std::size_t capacity() { return Capacity; }

  // Statistics since construction, for any thread: each is exact, but they are not taken at one instant.
  [[nodiscard]] std::uint64_t pushed() const CELL_RT { return pushed_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t dropped() const CELL_RT { return dropped_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::size_t high_water() const CELL_RT { return high_water_.load(std::memory_order_relaxed); }

 private:
  // The producer alone writes these counters, so a plain load and store is enough and saves the locked instruction.
  // Relaxed: they publish nothing but themselves.
  static void increment(std::atomic<std::uint64_t>& counter) noexcept {
    counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }

  boost::lockfree::spsc_queue<T, boost::lockfree::capacity<Capacity>> queue_;
  // On a cache line of the producer's own.
  alignas(64) std::atomic<std::uint64_t> pushed_{0};
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<std::size_t> high_water_{0};
};

}  // namespace cellmirror
