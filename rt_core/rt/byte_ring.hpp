// The edge between two threads where records of any length count: a ring of bytes that refuses when it is full.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "rt_core/base/contract.hpp"
#include "rt_core/base/real_time.hpp"

namespace cellmirror {

// One producer, one consumer, with a thread each; neither waits. A record is taken whole or not at all. All memory is
// taken when it is made.
class ByteRing {
 public:
  // Rounded up to a power of two.
  explicit ByteRing(std::size_t bytes)
      : size_(std::bit_ceil(std::max<std::size_t>(bytes, 64))), data_(std::make_unique<std::byte[]>(size_)) {}
  ByteRing(const ByteRing&) = delete;
  ByteRing& operator=(const ByteRing&) = delete;

  // Producer. False, and nothing is changed, where there is no room.
  bool push(std::span<const std::byte> record) CELL_RT {
    const auto length = static_cast<std::uint32_t>(record.size());
    if (record.size() + sizeof(length) > room()) return false;
    const std::uint64_t pushed = pushed_.load(std::memory_order_relaxed);  // only this thread writes it
    copy_in(pushed, &length, sizeof(length));
    copy_in(pushed + sizeof(length), record.data(), record.size());
    // Release: pairs with the acquire in pop(); the record is written before the consumer may see it.
    pushed_.store(pushed + sizeof(length) + record.size(), std::memory_order_release);
    return true;
  }
  // Producer. Bytes that a record and its length may have now.
  [[nodiscard]] std::size_t room() const CELL_RT {
    // Acquire: pairs with the release in pop(); the consumer's access to those bytes is over.
    return size_ -
           static_cast<std::size_t>(pushed_.load(std::memory_order_relaxed) - popped_.load(std::memory_order_acquire));
  }
  [[nodiscard]] std::size_t capacity() const CELL_RT { return size_; }

  // Consumer. Appends the oldest record to `out`; false where there is none. Not for the tick.
  bool pop(std::vector<std::byte>& out) {
    const std::uint64_t popped = popped_.load(std::memory_order_relaxed);  // only this thread writes it
    // Acquire: pairs with the release in push().
    if (popped == pushed_.load(std::memory_order_acquire)) return false;
    std::uint32_t length = 0;
    copy_out(popped, &length, sizeof(length));
    const std::size_t before = out.size();
    out.resize(before + length);
    copy_out(popped + sizeof(length), out.data() + before, length);
    // Release: pairs with the acquire in room().
    popped_.store(popped + sizeof(length) + length, std::memory_order_release);
    return true;
  }

 private:
  void copy_in(std::uint64_t at, const void* from, std::size_t size) CELL_RT {
    const auto begin = static_cast<std::size_t>(at & (size_ - 1));
    const std::size_t first = std::min(size, size_ - begin);
    std::memcpy(data_.get() + begin, from, first);
    std::memcpy(data_.get(), static_cast<const std::byte*>(from) + first, size - first);
  }
  void copy_out(std::uint64_t at, void* to, std::size_t size) const {
    const auto begin = static_cast<std::size_t>(at & (size_ - 1));
    const std::size_t first = std::min(size, size_ - begin);
    std::memcpy(to, data_.get() + begin, first);
    std::memcpy(static_cast<std::byte*>(to) + first, data_.get(), size - first);
  }

  const std::size_t size_;
  const std::unique_ptr<std::byte[]> data_;
  // Bytes since the start. 64 bytes: the size of a cache line on the machines we run on.
  alignas(64) std::atomic<std::uint64_t> pushed_{0};
  alignas(64) std::atomic<std::uint64_t> popped_{0};
};

}  // namespace cellmirror
