// The connection between a process of ours and a confined one: messages both ways through shared memory, and a socket
// by which each wakes the other and notices the other's end. The owner's side never waits for the confined process and
// checks all that it reads from the memory.
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
  std::size_t to_child_bytes = 1U << 20U;    // messages that wait; a power of two
  std::size_t to_owner_bytes = 1U << 20U;    // likewise
  std::size_t longest_message = 64U << 10U;  // both ways; less than either of the above
};

// The descriptors that a confined process is started with.
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

// One side. send() by any thread, all else by one.
class Channel {
 public:
  // The owner's side, and what the child is given: its end of the socket and the memory.
  struct Ends;
  [[nodiscard]] static Result<Ends> make(const ChannelConfig& config);
  // The child's side, of the descriptors that it was started with. Fails where these are not ours.
  [[nodiscard]] static Result<Channel> attach();

  // A message that is `head` and then `body`. Does not wait. False: there is no room, it is too long, or the other side
  // has damaged the memory (damaged()).
  bool send(std::span<const std::byte> head, std::span<const std::byte> body = {});
  // The oldest message, in place of what `out` had.
  RingResult receive(std::vector<std::byte>& out);
  [[nodiscard]] bool damaged() const { return shared_->damaged.load(std::memory_order_relaxed); }

  // Sleeps until there is a message, one of `also` (at most kMostAlso) is ready as poll() has it, the other side has
  // ended, or `timeout`.
  static constexpr std::size_t kMostAlso = 3;
  void wait(Nanoseconds timeout, std::span<pollfd> also = {});
  // Since the last wait(): it ended without a message. For the owner, who counts the wakes of a child that lies.
  [[nodiscard]] bool ended() const { return ended_; }
  // Bytes by which the other side woke this one in the last wait().
  [[nodiscard]] std::size_t wakes() const { return wakes_; }

  // The child says what it has given up, before it reads bytes of strangers.
  void set_confinement(const ConfinementOutcome& outcome);
  [[nodiscard]] ConfinementOutcome confinement() const;
  // The child says that it is alive; the owner reads how often.
  void beat();
  [[nodiscard]] std::uint64_t beats() const;

 private:
  struct Header;
  // What must not move with the object.
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
