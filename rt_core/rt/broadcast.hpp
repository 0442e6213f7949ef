// The edge from one thread to several where only the newest value counts.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "rt_core/base/contract.hpp"
#include "rt_core/base/real_time.hpp"

namespace cellmirror {

// Newest wins: one writer thread, any number of readers with a thread each. The writer fills one buffer for all of
// them, and neither side ever waits for the other or tries twice. Latest, for more than one reader: each reader owns a
// buffer and has a mailbox with another one, writer and reader exchange them by single atomic exchanges. The writer
// alone counts the holders of each buffer; one without holders is free. With a buffer for each reader, one for each
// mailbox and one for the writer there is always a free one.
//
// Readers subscribe before the first publication, by one thread. All memory is taken then. Readers belong to the
// Broadcast and end with it.
template <class T>
class Broadcast {
  struct Buffer;

 public:
  // What a reader sees. `value` stays valid and unchanged until the same reader's next read().
  struct Reading {
    const T& value;              // the initial value before the first publication
    bool is_new = false;         // published since the read() before
    std::uint64_t sequence = 0;  // number of this publication, from 1; 0: nothing was ever published
  };

  class Reader {
   public:
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    // The reader's thread. The newest publication; with nothing new, the same as last time.
    [[nodiscard]] Reading read() CELL_RT {
      bool is_new = false;
      // Relaxed: only a hint whether an exchange is worth it; the exchange below orders everything.
      if ((mailbox_.load(std::memory_order_relaxed) & kFresh) != 0) {
        // Acquire: pairs with the release in publish(), makes the content of the buffer visible. Release: pairs with
        // the acquire in publish(); the last access to the buffer that is handed back is over.
        own_ = mailbox_.exchange(own_, std::memory_order_acq_rel) & ~kFresh;
        is_new = true;
      }
      const Buffer& buffer = *buffers_[own_];
      return Reading{buffer.value, is_new, buffer.sequence};
    }

    // Any thread. Publications that were replaced before this reader took them.
    [[nodiscard]] std::uint64_t overwritten() const CELL_RT { return overwritten_.load(std::memory_order_relaxed); }

   private:
    friend class Broadcast;
    explicit Reader(const std::vector<std::unique_ptr<Buffer>>& buffers) : buffers_(buffers) {}

    const std::vector<std::unique_ptr<Buffer>>& buffers_;
    alignas(64) std::atomic<std::uint32_t> mailbox_{kInitial};  // index of a buffer, and kFresh
    std::atomic<std::uint64_t> overwritten_{0};                 // written by the writer only
    alignas(64) std::uint32_t own_ = kInitial;                  // the reader's own
  };

  // Every buffer begins as a copy of `initial`.
  explicit Broadcast(T initial = T()) {
    add_buffer(std::move(initial));
    add_buffer(buffers_.front()->value);
  }
  Broadcast(const Broadcast&) = delete;
  Broadcast& operator=(const Broadcast&) = delete;

  // Before the first publication; not for the tick.
  Reader& subscribe() {
    CELLMIRROR_EXPECTS(published_count_ == 0);
    for (int i = 0; i < 2; ++i) add_buffer(buffers_.front()->value);
    holders_[kInitial] += 2;
    readers_.push_back(std::unique_ptr<Reader>(new Reader(buffers_)));
    return *readers_.back();
  }
  [[nodiscard]] bool has_readers() const CELL_RT { return !readers_.empty(); }

  // Writer. The buffer for the next publication, to be filled in place. It holds an old publication or the initial
  // value: set every field. The reference is valid until publish().
  [[nodiscard]] T& writable() CELL_RT { return buffers_[writer_buffer_]->value; }

  // Writer. Publishes what stands in writable().
  void publish() CELL_RT {
    buffers_[writer_buffer_]->sequence = ++published_count_;
    for (const std::unique_ptr<Reader>& reader : readers_) {
      // Release: the content of the buffer is visible to the reader whose acquire exchange takes it. Acquire: pairs
      // with the release in read(); a buffer that comes back is no longer read.
      const std::uint32_t previous = reader->mailbox_.exchange(writer_buffer_ | kFresh, std::memory_order_acq_rel);
      ++holders_[writer_buffer_];
      --holders_[previous & ~kFresh];
      if ((previous & kFresh) != 0) {
        // Relaxed: statistics, and only this thread writes them.
        reader->overwritten_.store(reader->overwritten_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      }
    }
    // The lowest, so that as few buffers as possible are in use: they stay in the cache.
    writer_buffer_ = 0;
    while (holders_[writer_buffer_] != 0) ++writer_buffer_;
  }

 private:
  static constexpr std::uint32_t kFresh = 1U << 31U;  // the buffer in the mailbox was published and not yet read
  static constexpr std::uint32_t kInitial = 0;        // the buffer that all readers begin with

  // 64 bytes: the size of a cache line on the machines we run on, so that threads do not share one.
  struct alignas(64) Buffer {
    T value;
    std::uint64_t sequence = 0;
  };

  void add_buffer(T value) {
    buffers_.push_back(std::make_unique<Buffer>(Buffer{std::move(value)}));
    holders_.push_back(0);
  }

  std::vector<std::unique_ptr<Buffer>> buffers_;
  std::vector<std::unique_ptr<Reader>> readers_;
  // The writer's own.
  std::vector<std::uint32_t> holders_;  // by buffer: readers and mailboxes that hold it
  std::uint32_t writer_buffer_ = 1;
  std::uint64_t published_count_ = 0;
};

}  // namespace cellmirror
