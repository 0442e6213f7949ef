// A System V message queue that this process made, keeps alive and removes.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include "ipc/sysv/key_lock.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

// What became of a call that does not wait.
enum class QueueOutcome { done, full, empty, gone, failed };

class OwnedQueue {
 public:
  struct Options {
    std::string purpose;  // for messages, e.g. "SCRIPT input"
    std::int32_t key = 0;
    std::uint32_t mode = 0600;
    std::string instance = "default";
  };

  // Takes the key's lock and creates the queue. An existing queue is a leftover of an ended process: it is removed with
  // all its messages (discarded() is their number) and recreated. Refused, with the remedy: a key that another gateway
  // holds, a queue of another user, one with a wider mode than `mode`.
  static Result<std::unique_ptr<OwnedQueue>> make(Options options);

  ~OwnedQueue();  // removes the queue, unless it is no longer ours
  OwnedQueue(const OwnedQueue&) = delete;
  OwnedQueue& operator=(const OwnedQueue&) = delete;

  // Never waits. `type` > 0.
  [[nodiscard]] QueueOutcome send_now(long type, std::span<const char> text);
  // Takes the oldest message of `type` (0: of any) out and forgets it. Never waits.
  [[nodiscard]] QueueOutcome discard_oldest(long type);
  // Waits until a message of any type comes (done), or the queue is removed (gone). `text` is at least one byte longer
  // than the longest message expected: longer ones are truncated, visible by their length.
  [[nodiscard]] QueueOutcome receive(long& type, std::span<char> text, std::size_t& length);

  // After `gone`: recreates the queue. Fails if another process has taken the key meanwhile, and after close(). Any
  // thread.
  [[nodiscard]] Result<void> recreate();
  // Why the key's queue is not ours although it should be, since the last recreate(); empty: it is. Any thread.
  [[nodiscard]] std::string problem() const;
  // Removes the queue for good and gives the key back: receive() in another thread ends with `gone`. Any thread.
  void close();
  [[nodiscard]] bool closed() const { return closed_.load(std::memory_order_acquire); }

  [[nodiscard]] const Options& options() const { return options_; }
  [[nodiscard]] int id() const { return id_.load(std::memory_order_acquire); }  // the kernel's number
  [[nodiscard]] std::uint64_t discarded() const { return discarded_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t recreated() const { return recreated_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t waiting() const;     // messages in it now
  [[nodiscard]] std::int32_t last_sender() const;  // the process that sent last; 0 where unknown
  // Whether another process took out the message that was taken out last.
  [[nodiscard]] bool last_read_by_another() const;

 private:
  OwnedQueue(Options options, KeyLock lock, int id, std::uint64_t discarded);
  Result<void> try_to_recreate();

  Options options_;
  KeyLock lock_;
  mutable std::mutex mutex_;  // making and removing, and what follows
  std::string problem_;
  std::atomic<int> id_;
  std::atomic<bool> closed_{false};
  std::atomic<std::uint64_t> discarded_;
  std::atomic<std::uint64_t> recreated_{0};
};

}  // namespace cellmirror
