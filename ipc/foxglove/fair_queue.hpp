// The messages that wait for one client, in a queue for each of its subscriptions. A queue is bounded; of a full one
// the oldest message is left out. Messages are given out so that every subscription gets the same number of bytes, by
// start-time fair queueing (Goyal, Vin, Cheng: SIGCOMM 1996): a topic with much data delays the others by one of its
// messages at most. Pure; one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace cellmirror::foxglove {

// Shared by all clients that get it.
using Payload = std::shared_ptr<const std::string>;

struct Waiting {
  std::uint32_t subscription = 0;
  std::uint64_t time_ns = 0;
  Payload payload;
};

class FairQueue {
 public:
  // A single message may be longer; then it is the only one.
  static constexpr std::size_t kMostBytes = std::size_t{1} << 20;  // of a subscription

  // `depth`: messages, at least one.
  void open(std::uint32_t subscription, std::size_t depth);
  void close(std::uint32_t subscription);
  // How many older messages found no room any more. Nothing happens for a subscription that is not open.
  std::size_t push(std::uint32_t subscription, std::uint64_t time_ns, const Payload& payload);
  // The next one; none: nothing waits.
  [[nodiscard]] std::optional<Waiting> pop();
  [[nodiscard]] bool empty() const { return waiting_ == 0; }
  // Left out since open().
  [[nodiscard]] std::uint64_t dropped(std::uint32_t subscription) const;

 private:
  struct Lane {
    std::size_t depth = 1;
    std::size_t bytes = 0;
    std::uint64_t start = 0;  // virtual time in bytes at which its first message begins
    std::uint64_t dropped = 0;
    std::deque<Waiting> messages;
  };

  std::map<std::uint32_t, Lane> lanes_;
  std::uint64_t now_ = 0;  // virtual time: the start of what was given out last
  std::size_t waiting_ = 0;
};

}  // namespace cellmirror::foxglove
