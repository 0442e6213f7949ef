// The edge between two threads where only the newest value counts.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

#include "rt_core/base/real_time.hpp"

namespace cellmirror {

// Newest wins: one writer thread, one reader thread, neither ever waits for the other or tries twice (a triple buffer:
// the writer owns one buffer, the reader owns one, the third changes hands by a single atomic exchange).
//
// T is any default constructible type; both sides keep references into the object, so it neither moves nor copies.
// Three T live inside: put large ones on the heap as part of their owner. A T with heap memory of its own is allowed
// where neither side is the tick.
template <class T>
class Latest {
 public:
  // What the reader sees. `value` stays valid and unchanged until the reader's next read().
  struct Reading {
    const T& value;              // T{} before the first publication
    bool is_new = false;         // published since the read() before
    std::uint64_t sequence = 0;  // number of this publication, from 1; 0: nothing was ever published
  };

  Latest() = default;
  Latest(const Latest&) = delete;
  Latest& operator=(const Latest&) = delete;

  // Writer. Copies `value` and publishes it.
  void write(const T& value) CELL_RT {
    static_assert(std::is_nothrow_copy_assignable_v<T>, "use writable() and publish() for types whose copy may throw");
    writable() = value;
    publish();
  }

  // Writer. The buffer for the next publication, to be filled in place. It holds an OLD publication (or T{}), never the
  // newest one for certain: set every field. The reference is valid until publish().
  [[nodiscard]] T& writable() CELL_RT { return slots_[writer_slot_].value; }

  // Writer. Publishes what stands in writable().
  void publish() CELL_RT {
    slots_[writer_slot_].sequence = ++published_count_;
    // Release: what was written into the slot is visible to the reader whose acquire exchange in read() takes it.
    // Acquire: pairs with the release in read() that handed the returned slot back, so that the reader's last access
    // is over before we write into it again.
    const std::uint8_t previous =
        middle_.exchange(static_cast<std::uint8_t>(writer_slot_ | kFresh), std::memory_order_acq_rel);
    writer_slot_ = previous & kSlotMask;
    // Relaxed: statistics; they publish nothing but themselves, and only this thread writes them.
    published_.store(published_count_, std::memory_order_relaxed);
    if ((previous & kFresh) != 0) {
      overwritten_.store(overwritten_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    }
  }

  // Reader. The newest publication; with nothing new, the same as last time.
  [[nodiscard]] Reading read() CELL_RT {
    bool is_new = false;
    // Relaxed: only a hint whether an exchange is worth it; the exchange below orders everything. A publication that
    // this load does not see yet is seen by the next read().
    if ((middle_.load(std::memory_order_relaxed) & kFresh) != 0) {
      // Acquire: pairs with the release in publish(), makes the slot's content visible. Release: pairs with the acquire
      // in publish(), our last access to the slot that we hand back is over.
      const std::uint8_t previous = middle_.exchange(reader_slot_, std::memory_order_acq_rel);
      reader_slot_ = previous & kSlotMask;
      is_new = true;
    }
    const Slot& slot = slots_[reader_slot_];
    return Reading{slot.value, is_new, slot.sequence};
  }

  // Any thread. How many values were published, and how many of them were replaced before the reader came.
  [[nodiscard]] std::uint64_t published() const CELL_RT { return published_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t overwritten() const CELL_RT { return overwritten_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::uint8_t kSlotMask = 0x3;
  static constexpr std::uint8_t kFresh = 0x4;  // the middle slot was published and not yet read

  // 64 bytes: the size of a cache line on the machines we run on, so that writer and reader do not share one.
  struct alignas(64) Slot {
    T value{};
    std::uint64_t sequence = 0;
  };

  std::array<Slot, 3> slots_{};
  alignas(64) std::atomic<std::uint8_t> middle_{1};
  alignas(64) std::uint8_t writer_slot_ = 0;  // the writer's own
  std::uint64_t published_count_ = 0;         // the writer's own
  std::atomic<std::uint64_t> published_{0};
  std::atomic<std::uint64_t> overwritten_{0};
  alignas(64) std::uint8_t reader_slot_ = 2;  // the reader's own
};

}  // namespace cellmirror
