// The edge for history: the last values of a thread that never waits, copied out by any thread (the flight
// recorder).
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "rt_core/base/real_time.hpp"

namespace cellmirror {

// One writer thread overwrites the oldest entry; any number of threads copy the newest entries meanwhile. The writer is
// wait-free and does not know of its readers. Every slot is a sequence lock (Lameter 2005; the form without data races
// after Boehm, "Can seqlocks get along with programming language memory models?", MSPC 2012): the entry travels as
// atomic 64-bit words, and a copy counts only if the slot's sequence was the expected one before and after it.
//
// All memory is inside the object: put large ones on the heap as part of their owner.
template <class T, std::size_t Capacity>
class Ring {
  static_assert(Capacity > 0);
  static_assert(std::is_trivially_copyable_v<T>, "entries are copied as raw words");

 public:
  Ring() = default;
  Ring(const Ring&) = delete;
  Ring& operator=(const Ring&) = delete;

  // Writer. Takes the place of the oldest entry.
  void push(const T& entry) CELL_RT {
    // Relaxed: this thread alone writes the count.
    const std::uint64_t number = written_.load(std::memory_order_relaxed);
    Slot& slot = slots_[number % Capacity];
    // Odd: being written. Relaxed is enough: the release of every word below keeps this store before it, so that a
    // reader that sees one new word also sees (when it loads the sequence again) that the sequence has moved on.
    slot.sequence.store(2 * number + 1, std::memory_order_relaxed);
    const auto* source = reinterpret_cast<const unsigned char*>(&entry);
    for (std::size_t i = 0; i < kWords; ++i) {
      std::uint64_t word = 0;
      std::memcpy(&word, source + i * sizeof(word), std::min(sizeof(word), sizeof(T) - i * sizeof(word)));
      // Release: pairs with the acquire load of the same word in copy_entry(). (Words with release and acquire instead
      // of fences: the same instructions on x86-64, and ThreadSanitizer follows them.)
      slot.words[i].store(word, std::memory_order_release);
    }
    // Even: entry `number` is complete. Release: pairs with the first acquire load of the sequence in copy_entry().
    slot.sequence.store(2 * number + 2, std::memory_order_release);
    // Release: pairs with the acquire in newest().
    written_.store(number + 1, std::memory_order_release);
  }

  // Any thread; not for the tick (its time grows with the number of entries). Fills `out` from its front with the
  // newest entries, oldest first and without gaps, at most out.size() and Capacity of them; returns how many. The
  // oldest ones that were overwritten while the copy was made are left out and counted in torn().
  std::size_t newest(std::span<T> out) const noexcept {
    std::size_t copied = 0;
    // Once more where the writer went round the whole ring before the first entry was copied.
    for (int attempt = 0; attempt < kAttempts && copied == 0; ++attempt) {
      // Acquire: pairs with the release in push(); the entries before the count are complete, or replaced by newer
      // ones.
      const std::uint64_t written = written_.load(std::memory_order_acquire);
      const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>({written, out.size(), Capacity}));
      // Backwards: the writer replaces the oldest first, so from the first entry that is gone all older ones are.
      while (copied < wanted && copy_entry(written - 1 - copied, out[wanted - 1 - copied])) {
        ++copied;
      }
      std::move(out.begin() + (wanted - copied), out.begin() + wanted, out.begin());
      torn_.fetch_add(wanted - copied, std::memory_order_relaxed);  // statistics, by many readers
      if (wanted == 0) {
        break;
      }
    }
    return copied;
  }

  // The same with memory of its own.
  [[nodiscard]] std::vector<T> newest(std::size_t most = Capacity) const {
    std::vector<T> entries(std::min(most, Capacity));
    entries.resize(newest(std::span<T>(entries)));
    return entries;
  }

  [[nodiscard]] static constexpr std::size_t capacity() { return Capacity; }
  // Any thread. Entries ever written, and entries that readers had to leave out.
  [[nodiscard]] std::uint64_t written() const CELL_RT { return written_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t torn() const CELL_RT { return torn_.load(std::memory_order_relaxed); }

 private:
  static constexpr int kAttempts = 4;
  static constexpr std::size_t kWords = (sizeof(T) + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t);

  struct Slot {
    std::atomic<std::uint64_t> sequence{0};
    std::array<std::atomic<std::uint64_t>, kWords> words{};
  };

  bool copy_entry(std::uint64_t number, T& out) const noexcept {
    const Slot& slot = slots_[number % Capacity];
    const std::uint64_t complete = 2 * number + 2;
    // Acquire: pairs with the writer's last store of the sequence; its words are visible.
    if (slot.sequence.load(std::memory_order_acquire) != complete) {
      return false;
    }
    std::array<std::uint64_t, kWords> words;
    for (std::size_t i = 0; i < kWords; ++i) {
      // Acquire: pairs with the writer's store of the word; keeps the second load of the sequence behind it.
      words[i] = slot.words[i].load(std::memory_order_acquire);
    }
    // Relaxed: if any word above was of a newer entry, its acquire has made that entry's odd sequence visible here.
    if (slot.sequence.load(std::memory_order_relaxed) != complete) {
      return false;
    }
    std::memcpy(static_cast<void*>(std::addressof(out)), words.data(), sizeof(T));
    return true;
  }

  std::array<Slot, Capacity> slots_{};
  alignas(64) std::atomic<std::uint64_t> written_{0};
  alignas(64) mutable std::atomic<std::uint64_t> torn_{0};
};

}  // namespace cellmirror
