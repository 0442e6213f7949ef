// What waits for the broker: bounded, whatever it does. Retained messages are kept in their newest form, events and
// replies up to a number, of joint states only the newest. No lock, no clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drivers/mqtt/outgoing.hpp"

namespace cellmirror::mqtt {

class Outbox {
 public:
  static constexpr std::size_t kMostEvents = 1000;
  static constexpr std::size_t kMostReplies = 256;
  static constexpr std::size_t kMostJointStates = 128;
  static constexpr std::size_t kMostBytes = std::size_t{1} << 20;  // of each kind

  struct Counters {
    std::uint64_t events_dropped = 0;  // the oldest ones
    std::uint64_t replies_dropped = 0;
    std::uint64_t joint_states_dropped = 0;
    std::uint64_t replaced = 0;  // retained ones, by newer ones
  };

  // Kind::other is no kind of the outbox.
  void put(Outgoing message);
  // Retained ones first, then replies, events, joint states; each kind in the order of put().
  [[nodiscard]] std::optional<Outgoing> take();
  // Of a lost connection, oldest first: these were taken and never confirmed. They go first, but a newer retained one
  // takes the place of an older one, and joint states are dropped.
  void give_back(std::vector<Outgoing> unconfirmed);

  [[nodiscard]] const Counters& counters() const { return counters_; }
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Line {
    std::size_t most;
    std::deque<Outgoing> messages = {};
    std::size_t bytes = 0;

    void push_back(Outgoing message);
    void push_front(Outgoing message);
    Outgoing pop_front();
    // Drops the oldest ones that are beyond the bounds; how many.
    std::uint64_t trim();
  };

  [[nodiscard]] Line& line(Outgoing::Kind kind);
  [[nodiscard]] std::uint64_t& dropped(Outgoing::Kind kind);

  std::map<std::string, Outgoing> retained_;  // by topic: a handful
  Line replies_{kMostReplies};
  Line events_{kMostEvents};
  Line joint_states_{kMostJointStates};
  Counters counters_;
};

}  // namespace cellmirror::mqtt
