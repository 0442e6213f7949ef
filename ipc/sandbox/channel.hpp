// A channel between cellmirror (the owner) and a confined process (the child). Two rings in shared memory carry the
// messages. A socket wakes a sleeping side and shows when the other process has ended. The owner never blocks on the
// child, and it checks every count and length that it reads from the memory.
#pragma once

#include <poll.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "ipc/sandbox/confinement.hpp"
#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/rt/shared_message_ring.hpp"

namespace cellmirror {

struct ChannelConfig {
  std::size_t to_child_bytes = 1U << 20U;    // capacity of the ring; a power of two
  std::size_t to_owner_bytes = 1U << 20U;    // likewise
  std::size_t longest_message = 64U << 10U;  // bytes, in both directions; has to fit both rings
};

// Descriptors of the child when it starts.
inline constexpr int kChildSocket = 0;
inline constexpr int kChildMemory = 3;

// A mapping of shared memory.
class SharedMapping {
 public:
  SharedMapping() = default;
  SharedMapping(std::byte* start, std::size_t size) : start_(start), size_(size) {}
  ~SharedMapping();
  SharedMapping(SharedMapping&& other) noexcept;
  SharedMapping& operator=(SharedMapping&& other) noexcept;

  [[nodiscard]] std::span<std::byte> bytes() const { return {start_, size_}; }

 private:
  std::byte* start_ = nullptr;
  std::size_t size_ = 0;
};

// One side of the channel. Any thread may call send(); one thread calls everything else.
class Channel {
 public:
  // The owner's side, and the two descriptors for the child.
  struct Ends;
  [[nodiscard]] static Result<Ends> make(const ChannelConfig& config);
  // The child's side, from kChildSocket and kChildMemory. Fails if cellmirror did not start this process.
  [[nodiscard]] static Result<Channel> attach();

  // Sends the message `head` + `body` without blocking. Returns false if the ring is full, the message is too long, or
  // the other side has damaged the memory (damaged()).
  bool send(std::span<const std::byte> head, std::span<const std::byte> body = {});
  // Replaces the content of `out` by the oldest message.
  RingResult receive(std::vector<std::byte>& out);
  [[nodiscard]] bool damaged() const { return shared_->damaged.load(std::memory_order_relaxed); }

  // Sleeps until a message arrives, a descriptor in `also` (at most kMostAlso) is ready as for poll(), the other
  // process ends, or `timeout` has passed.
  static constexpr std::size_t kMostAlso = 3;
  void wait(Nanoseconds timeout, std::span<pollfd> also = {});
  // True if wait() has seen the end of the other process.
  [[nodiscard]] bool ended() const { return ended_; }
  // Number of wake-ups that the other side sent before the last wait() returned. The owner uses it to detect a child
  // that wakes it without messages.
  [[nodiscard]] std::size_t wakes() const { return wakes_; }

  // The child reports the restrictions that are in force, before it reads bytes from a network.
  void set_confinement(const ConfinementOutcome& outcome);
  [[nodiscard]] ConfinementOutcome confinement() const;
  // The child counts a sign of life; the owner reads the count.
  void beat();
  [[nodiscard]] std::uint64_t beats() const;

 private:
  struct Header;
  // Members that cannot move with the object.
  struct Shared {
    std::mutex send_mutex;
    std::atomic<bool> damaged{false};
  };
  Channel(Descriptor socket, SharedMapping mapping, std::size_t longest, std::span<std::byte> out,
          std::span<std::byte> in);
  [[nodiscard]] static Channel on(Descriptor socket, SharedMapping mapping, bool owner);
  [[nodiscard]] Header& header() const;
  void drain_wakes();

  Descriptor socket_;
  SharedMapping mapping_;
  std::size_t longest_;
  SharedRingWriter out_;  // under the mutex
  SharedRingReader in_;
  std::unique_ptr<Shared> shared_ = std::make_unique<Shared>();
  bool ended_ = false;
  std::size_t wakes_ = 0;
};

struct Channel::Ends {
  Channel owner;
  Descriptor child_socket;
  Descriptor memory;
};

}  // namespace cellmirror
