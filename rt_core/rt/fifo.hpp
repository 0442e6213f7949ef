// The edge between two threads where every value counts: a bounded queue that refuses when it is full.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "rt_core/base/real_time.hpp"

namespace cellmirror {

// First in, first out, one producer thread, one consumer thread; wait-free on both sides. A push into a full queue is
// refused and counted, what is already inside stays. All memory is inside the object (Capacity * sizeof(T)) and touched
// by the constructor, so that no push meets a page fault: put large ones on the heap as part of their owner.
//
// A ring buffer between two counters (Lamport 1977), where each side keeps a copy of the other's counter and reads
// the real one only when the copy says full or empty (Lee, Bu, Chandranmenon, ANCS 2009): in the usual case no cache
// line but that of the data moves between processors. docs/decisions/0002-queues.md says why it is our own.
//
// The producer's and the consumer's role may move to another thread where something else orders the two (a join, a
// lock); two threads in one role at the same time are a bug that this class cannot see.
template <class T, std::size_t Capacity>
class Fifo {
  static_assert(Capacity > 0);
  static_assert(std::is_nothrow_move_assignable_v<T>, "values are moved into and out of the queue on the tick");

 public:
  Fifo() = default;
  Fifo(const Fifo&) = delete;
  Fifo& operator=(const Fifo&) = delete;

  // Producer. False where the queue was full: the value was dropped and counted.
  bool push(const T& value) CELL_RT
    requires std::is_trivially_copyable_v<T>
  {
    return push_with([&value](T& slot) { slot = value; });
  }
  // The same for what can only be moved. `value` is untouched where the queue was full.
  bool push_from(T& value) CELL_RT {
    return push_with([&value](T& slot) { slot = std::move(value); });
  }

  // Producer. Whether a push would be refused now; only the consumer can change a yes.
  [[nodiscard]] bool full() const CELL_RT {
    // Acquire: pairs with the release in pop(), for the push() that relies on the answer.
    return pushed_.load(std::memory_order_relaxed) - popped_.load(std::memory_order_acquire) == Capacity;
  }

  // Consumer. False where the queue was empty; `value` is untouched then.
  bool pop(T& value) CELL_RT {
    const std::uint64_t popped = popped_.load(std::memory_order_relaxed);  // only this thread writes it
    if (popped == pushed_seen_) {
      // Acquire: pairs with the release in push(); what the slot holds is visible.
      pushed_seen_ = pushed_.load(std::memory_order_acquire);
      if (popped == pushed_seen_) {
        return false;
      }
    }
    value = std::move(slots_[next_out_]);
    next_out_ = next_out_ + 1 == Capacity ? 0 : next_out_ + 1;
    // Release: pairs with the acquire in push(); our access to the slot is over before the producer reuses it.
    popped_.store(popped + 1, std::memory_order_release);
    return true;
  }

  [[nodiscard]] static constexpr std::size_t capacity() { return Capacity; }

  // For any thread; relaxed, because they publish nothing but themselves. Each counter is exact, but they are not taken
  // at one instant.
  // How many values are inside. Right for producer and consumer up to what the other side does meanwhile; for others it
  // may lag.
  [[nodiscard]] std::size_t size() const CELL_RT {
    const std::uint64_t popped = popped_.load(std::memory_order_relaxed);
    const std::uint64_t pushed = pushed_.load(std::memory_order_relaxed);
    return static_cast<std::size_t>(std::min<std::uint64_t>(pushed > popped ? pushed - popped : 0, Capacity));
  }
  [[nodiscard]] std::uint64_t pushed() const CELL_RT { return pushed_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t dropped() const CELL_RT { return dropped_.load(std::memory_order_relaxed); }
  // The largest fill level that a push has left behind.
  [[nodiscard]] std::size_t high_water() const CELL_RT { return high_water_.load(std::memory_order_relaxed); }

 private:
  template <class Put>
  bool push_with(const Put& put) CELL_RT {
    const std::uint64_t pushed = pushed_.load(std::memory_order_relaxed);  // only this thread writes it
    if (pushed - popped_seen_ == Capacity) {
      // Acquire: pairs with the release in pop(); the consumer's last access to the slot is over before it is reused.
      popped_seen_ = popped_.load(std::memory_order_acquire);
      if (pushed - popped_seen_ == Capacity) {
        dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
        return false;
      }
    }
    put(slots_[next_in_]);
    next_in_ = next_in_ + 1 == Capacity ? 0 : next_in_ + 1;
    // Release: pairs with the acquire in pop(); the slot is written before the consumer may see it.
    pushed_.store(pushed + 1, std::memory_order_release);
    note_fill_level(pushed + 1);
    return true;
  }

  void note_fill_level(std::uint64_t pushed) noexcept {
    const std::size_t known = high_water_.load(std::memory_order_relaxed);
    // The copy of the consumer's counter may be old, so the level by it may be too high: only then read the real
    // one.
    if (pushed - popped_seen_ > known) {
      // Acquire, although this is statistics: push() goes on to rely on the copy.
      popped_seen_ = popped_.load(std::memory_order_acquire);
      const auto level = static_cast<std::size_t>(pushed - popped_seen_);
      if (level > known) {
        high_water_.store(level, std::memory_order_relaxed);
      }
    }
  }

  // 64 bytes: the size of a cache line on the machines we run on. The producer's part, the consumer's part and the data
  // lie on lines of their own.
  alignas(64) std::atomic<std::uint64_t> pushed_{0};
  std::uint64_t popped_seen_ = 0;  // the producer's own: popped_ as it last saw it
  std::size_t next_in_ = 0;        // the producer's own: pushed_ % Capacity
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<std::size_t> high_water_{0};
  alignas(64) std::atomic<std::uint64_t> popped_{0};
  std::uint64_t pushed_seen_ = 0;  // the consumer's own: pushed_ as it last saw it
  std::size_t next_out_ = 0;       // the consumer's own: popped_ % Capacity
  alignas(64) std::array<T, Capacity> slots_{};
};

}  // namespace cellmirror
