// The protocols that share a channel: which of them gets a frame or is due, and what they send. No thread, no waiting.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/can/stream/can_protocol.hpp"
#include "drivers/can/stream/identifier_routes.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

// A stream as its channel sees it. Called on the channel's thread, start() of the first one before that exists.
class ChannelMember {
 public:
  virtual ~ChannelMember() = default;

 private:
  friend class ChannelMembers;

  // Starts the protocol, which then exists until the member is removed.
  virtual void start(Timestamp now) = 0;
  [[nodiscard]] virtual CanProtocol& protocol() = 0;
  // Publishes what its status reports. Never waits.
  virtual void publish() = 0;
  // The channel did not take a frame of one of its nodes.
  virtual void count_refused() = 0;
  // The state of the bus was written to the log.
  virtual void keep_error(const std::string& text) = 0;

  std::uint16_t number_ = 0;  // on its channel
};

class ChannelMembers {
 public:
  // `clock` outlives this.
  explicit ChannelMembers(const Clock& clock) : clock_(&clock) {}

  // What frames go to from now on; outlives its use here.
  void set_channel(CanChannel& channel) { channel_ = &channel; }
  // Starts the member, which outlives its membership.
  void add(ChannelMember& member, Timestamp now);
  void remove(ChannelMember& member);
  // Starts all members again.
  void restart(Timestamp now);

  // A frame of the channel, to those that take it. What they answer goes out together, before this returns.
  void receive(const CanFrame& frame, Timestamp now);
  // What members have sent, to the other nodes that take it: after receive() of the frame that it answers, as on a bus.
  // What they send then waits for the next call, so that no two nodes can keep this going.
  void deliver_waiting();
  [[nodiscard]] bool has_waiting() const { return !waiting_.empty(); }

  [[nodiscard]] Timestamp next_due() const;
  // The one that has been due for the longest time.
  void advance_next(Timestamp now);

  // Lets those publish that were called since.
  void publish();
  void keep_error(const std::string& text);

  // Of a node of the member: sent, and heard by the other nodes.
  void send_from(const ChannelMember& member, std::size_t node, const CanFrame& frame);
  // Frames of members that others would take, but for which no room was left.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  static constexpr std::size_t kTogether = 64;    // frames that are sent with one call
  static constexpr std::size_t kWaiting = 1'024;  // frames that wait for the other nodes

  struct Entry {
    ChannelMember* member = nullptr;  // null: the place is free
    Timestamp due;
    std::uint64_t revision = 0;  // of its routes
    bool called = false;         // since publish()
  };
  struct Sent {
    CanListener sender;
    CanFrame frame;
  };
  struct Waiting {
    CanListener sender;
    CanFrame frame;
    Timestamp time;
  };

  void call(CanListener listener, const CanFrame& frame, Timestamp now);
  void send_together();
  void sent(const Sent& sent, bool taken);
  // Takes over when those are due that were called, and rebuilds the routes where they have others.
  void look_after_calls();
  void rebuild();

  const Clock* clock_;
  CanChannel* channel_ = nullptr;
  std::vector<Entry> entries_;
  IdentifierRoutes routes_;
  bool together_ = false;  // what is sent waits in `outgoing_`
  std::vector<Sent> outgoing_;
  std::vector<Waiting> waiting_;
  std::vector<Waiting> delivered_;
  std::uint64_t dropped_ = 0;
};

}  // namespace cellmirror::can
