// A ring for messages of any length from one process to another, in memory that both have mapped. The other process is
// not trusted: whatever it writes there and whenever, this side stays within the memory and its loops end.
//
// Memory order. `written` is stored with release after the bytes of a message and loaded with acquire before they are
// read; `read` likewise in the other direction. A reader that is about to sleep sets `waits` and then looks at
// `written` again; a writer stores `written` and then looks at `waits`. Both pairs are sequentially consistent, so that
// at least one of the two sees the other: no message is left behind while its reader sleeps.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "rt_core/base/contract.hpp"

namespace cellmirror {

// The start of the memory. An all-zero header is an empty ring.
struct SharedRingHeader {
  static constexpr std::size_t kLine = 64;  // so that the two sides do not take cache lines from each other

  alignas(kLine) std::atomic<std::uint64_t> written{0};  // bytes since the start; the writer's
  alignas(kLine) std::atomic<std::uint64_t> read{0};     // likewise; the reader's
  alignas(kLine) std::atomic<std::uint32_t> waits{0};    // 1: the reader sleeps and has to be woken
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free && std::atomic<std::uint32_t>::is_always_lock_free,
              "a lock in one process would mean nothing to the other");

enum class RingResult : std::uint8_t { done, none, damaged };  // none: no room, or no message

namespace shared_ring {

inline constexpr std::size_t kHead = sizeof(std::uint64_t);  // the length, in front of each message

// Bytes that a message occupies: messages begin at multiples of eight bytes.
[[nodiscard]] constexpr std::size_t occupied(std::size_t length) { return kHead + (length + 7) / 8 * 8; }

}  // namespace shared_ring

// Memory for a ring of `capacity` bytes (a power of two).
[[nodiscard]] constexpr std::size_t shared_ring_bytes(std::size_t capacity) {
  return sizeof(SharedRingHeader) + capacity;
}

class SharedRingSide {
 public:
  // `memory`: of shared_ring_bytes(), aligned to SharedRingHeader::kLine; outlives this.
  explicit SharedRingSide(std::span<std::byte> memory)
      : header_(reinterpret_cast<SharedRingHeader*>(memory.data())),
        data_(memory.data() + sizeof(SharedRingHeader)),
        size_(memory.size() - sizeof(SharedRingHeader)) {
    CELLMIRROR_EXPECTS(memory.size() > sizeof(SharedRingHeader) && std::has_single_bit(size_));
  }
  [[nodiscard]] std::size_t capacity() const { return size_; }

 protected:
  [[nodiscard]] SharedRingHeader& header() { return *header_; }
  void copy_in(std::uint64_t at, std::span<const std::byte> from) {
    const std::size_t begin = at & (size_ - 1);
    const std::size_t first = std::min(from.size(), size_ - begin);
    if (first > 0) std::memcpy(data_ + begin, from.data(), first);
    if (first < from.size()) std::memcpy(data_, from.data() + first, from.size() - first);
  }
  void copy_out(std::uint64_t at, std::span<std::byte> to) const {
    const std::size_t begin = at & (size_ - 1);
    const std::size_t first = std::min(to.size(), size_ - begin);
    if (first > 0) std::memcpy(to.data(), data_ + begin, first);
    if (first < to.size()) std::memcpy(to.data() + first, data_, to.size() - first);
  }

 private:
  SharedRingHeader* header_;
  std::byte* data_;
  std::size_t size_;
};

// One thread.
class SharedRingWriter final : public SharedRingSide {
 public:
  using SharedRingSide::SharedRingSide;

  // Writes the message `head` + `body`. Returns none, without any change, if there is no room.
  RingResult write(std::span<const std::byte> head, std::span<const std::byte> body = {}) {
    const std::uint64_t read = header().read.load(std::memory_order_acquire);
    if (read < last_read_ || read > written_) return RingResult::damaged;
    last_read_ = read;
    const std::size_t length = head.size() + body.size();
    if (shared_ring::occupied(length) > capacity() - static_cast<std::size_t>(written_ - read)) return RingResult::none;
    const std::uint64_t front = length;
    copy_in(written_, std::as_bytes(std::span(&front, 1)));
    copy_in(written_ + shared_ring::kHead, head);
    copy_in(written_ + shared_ring::kHead + head.size(), body);
    written_ += shared_ring::occupied(length);
    header().written.store(written_, std::memory_order_seq_cst);
    return RingResult::done;
  }
  // Returns true once for each sleep of the reader, which has to be woken then.
  [[nodiscard]] bool reader_sleeps() {
    return header().waits.load(std::memory_order_seq_cst) != 0 &&
           header().waits.exchange(0, std::memory_order_seq_cst) != 0;
  }

 private:
  // Own copies: the other side can change the shared words.
  std::uint64_t written_ = 0;
  std::uint64_t last_read_ = 0;
};

// One thread.
class SharedRingReader final : public SharedRingSide {
 public:
  using SharedRingSide::SharedRingSide;

  // Replaces the content of `out` by the oldest message, of at most `longest` bytes. Returns damaged for an impossible
  // length or count.
  RingResult read(std::vector<std::byte>& out, std::size_t longest) {
    const std::uint64_t written = header().written.load(std::memory_order_acquire);
    if (written == read_) return RingResult::none;
    const std::uint64_t there = written - read_;  // wraps where the other side went back
    if (there > capacity() || there < shared_ring::kHead) return RingResult::damaged;
    std::uint64_t length = 0;
    copy_out(read_, std::as_writable_bytes(std::span(&length, 1)));
    if (length > longest || shared_ring::occupied(static_cast<std::size_t>(length)) > there) return RingResult::damaged;
    out.resize(static_cast<std::size_t>(length));
    copy_out(read_ + shared_ring::kHead, out);
    read_ += shared_ring::occupied(out.size());
    header().read.store(read_, std::memory_order_release);
    return RingResult::done;
  }
  // To be called before the reader sleeps. Returns false if a message has arrived.
  [[nodiscard]] bool prepare_to_sleep() {
    header().waits.store(1, std::memory_order_seq_cst);
    if (header().written.load(std::memory_order_seq_cst) == read_) return true;
    awake();
    return false;
  }
  // To be called after a sleep: the writer need not wake the reader any more.
  void awake() { header().waits.store(0, std::memory_order_relaxed); }

 private:
  std::uint64_t read_ = 0;
};

}  // namespace cellmirror
