// Words in memory that another process writes while we read, and a lock (seqlock) around a section of them.
//
// The other process is not trusted. Whatever it writes and whenever: every word is copied by value, once, by an atomic
// access, so that there is no data race; the number of tries is bounded; no word is used as an offset or a length here.
//
// Memory order. The writer makes the lock odd, stores the words with release, then makes the lock even with release.
// The reader loads the lock with acquire, the words with acquire, and the lock again.
// - A reader that meets a word of a write under way has, by that word's release and acquire, also to see the odd lock
//   (or a later one) in its second load: the attempt is discarded.
// - A reader whose first load of the lock is even sees, by the lock's release and acquire, no word older than that. So
//   two equal even loads enclose words of one write. Release and acquire of every word take the place of fences, which
//   ThreadSanitizer cannot follow; they are plain loads and stores on x86-64 (H.-J. Boehm, "Can seqlocks get along with
//   programming language memory models?", MSPC 2012).
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/base/real_time.hpp"

namespace cellmirror::shared_words {

static_assert(std::atomic_ref<std::uint64_t>::is_always_lock_free &&
                  std::atomic_ref<std::uint32_t>::is_always_lock_free,
              "a lock in one process would say nothing to the other");

// Tries of a reader. One that finds the lock odd costs one load; a whole copy costs some 50 ns.
inline constexpr int kTries = 32;

// Whether words of 8 bytes can be accessed in place there.
[[nodiscard]] inline bool is_aligned(std::span<const std::byte> memory) CELL_RT {
  return std::bit_cast<std::uintptr_t>(memory.data()) % alignof(std::uint64_t) == 0;
}

template <class Word>
[[nodiscard]] constexpr Word little(Word word) CELL_RT {
  if constexpr (std::endian::native == std::endian::big) {
    return std::bit_cast<Word>([](auto bytes) {
      for (std::size_t i = 0; i < bytes.size() / 2; ++i) std::swap(bytes[i], bytes[bytes.size() - 1 - i]);
      return bytes;
    }(std::bit_cast<std::array<std::byte, sizeof(Word)>>(word)));
  }
  return word;
}

// `offset` is a multiple of the word's size and within `memory`: constants of a layout, checked by the caller. A place
// is only ever accessed with one size of word. The cast away of const serves atomic_ref, which takes no const object
// before C++26: memory that is mapped for reading only is only loaded from.
template <class Word>
[[nodiscard]] std::atomic_ref<Word> at(std::span<const std::byte> memory, std::size_t offset) CELL_RT {
  auto* place = const_cast<std::byte*>(memory.data() + offset);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
  return std::atomic_ref<Word>(*reinterpret_cast<Word*>(place));
}

template <class Word>
[[nodiscard]] Word load(std::span<const std::byte> memory, std::size_t offset) CELL_RT {
  return little(at<Word>(memory, offset).load(std::memory_order_acquire));
}

template <class Word>
void store(std::span<std::byte> memory, std::size_t offset, Word word) CELL_RT {
  at<Word>(memory, offset).store(little(word), std::memory_order_release);
}

// Writes a word without changing it: its page belongs to this process then, and access does not fault.
inline void touch(std::span<std::byte> memory, std::size_t offset) CELL_RT {
  at<std::uint64_t>(memory, offset).fetch_or(0, std::memory_order_relaxed);
}

inline void store_f64(std::span<std::byte> memory, std::size_t offset, double value) CELL_RT {
  store(memory, offset, std::bit_cast<std::uint64_t>(value));
}
inline void store_f32(std::span<std::byte> memory, std::size_t offset, float value) CELL_RT {
  store(memory, offset, std::bit_cast<std::uint32_t>(value));
}
// Two numbers of 4 bytes, the first at the lower address.
[[nodiscard]] constexpr std::uint64_t pair(std::uint32_t first, std::uint32_t second) CELL_RT {
  return first | std::uint64_t{second} << 32;
}
[[nodiscard]] constexpr std::uint32_t first_of(std::uint64_t word) CELL_RT { return static_cast<std::uint32_t>(word); }
[[nodiscard]] constexpr std::uint32_t second_of(std::uint64_t word) CELL_RT {
  return static_cast<std::uint32_t>(word >> 32);
}

// The section is being written for as long as this lives. One writer at a time; a lock that a dead writer left odd
// stays odd until this one is done.
class WriteLock {
 public:
  WriteLock(std::span<std::byte> memory, std::size_t offset) CELL_RT : memory_(memory),
                                                                       offset_(offset),
                                                                       odd_(load<std::uint64_t>(memory, offset) | 1u) {
    store(memory_, offset_, odd_);
  }
  ~WriteLock() { store(memory_, offset_, odd_ + 1); }
  WriteLock(const WriteLock&) = delete;
  WriteLock& operator=(const WriteLock&) = delete;

 private:
  std::span<std::byte> memory_;
  std::size_t offset_;
  std::uint64_t odd_;
};

// Copies words until a try met no writer: `copy` is called with nothing and only loads. False where every try was torn.
// `lock`: the even lock of the copy.
template <class Copy>
[[nodiscard]] bool read_locked(std::span<const std::byte> memory, std::size_t offset, std::uint64_t& lock,
                               Copy copy) CELL_RT {
  for (int i = 0; i < kTries; ++i) {
    const auto before = load<std::uint64_t>(memory, offset);
    if (before % 2 != 0) continue;
    copy();
    if (load<std::uint64_t>(memory, offset) == before) {
      lock = before;
      return true;
    }
  }
  return false;
}

// N words of 8 bytes from `offset` on.
template <std::size_t N>
void load_words(std::span<const std::byte> memory, std::size_t offset, std::array<std::uint64_t, N>& words) CELL_RT {
  for (std::size_t i = 0; i < N; ++i) words[i] = load<std::uint64_t>(memory, offset + 8 * i);
}

}  // namespace cellmirror::shared_words
