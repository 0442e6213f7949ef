// What speaks on a channel on behalf of a stream, and what it may call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/can/stream/identifier_routes.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/can_channel.hpp"
#include "rt_core/ports/joint_stream.hpp"

namespace cellmirror::can {

// What a protocol may call while it is called itself, on the channel's thread.
class CanProtocolHost {
 public:
  virtual ~CanProtocolHost() = default;
  // At once. False where the channel refused the frame.
  virtual bool send(const CanFrame& frame) = 0;
  // From one of the protocol's nodes: the other nodes of the channel hear it too, as on a bus. It goes with the other
  // answers to the frame under way; the stream counts it where the channel refuses it.
  virtual void send_from(std::size_t node, const CanFrame& frame) = 0;
  virtual void push(const JointSample& sample) = 0;
  // Written to the log; what is wrong is kept for status() too. `kind` for the log's rate limiting: "heartbeat", ...
  virtual void note(Severity severity, std::string_view kind, const std::string& text) = 0;
};

// Called on the channel's thread (the start() of the first one on a channel before that thread exists), except for
// describe().
class CanProtocol {
 public:
  virtual ~CanProtocol() = default;
  virtual void start(Timestamp now) = 0;
  // `node`: which of its nodes takes the frame; 0 where add_routes() names none.
  virtual void receive(const CanFrame& frame, Timestamp now, std::size_t node) = 0;
  virtual void advance(Timestamp now) = 0;
  [[nodiscard]] virtual Timestamp next_due() const = 0;
  // Publishes what describe() reports. Never waits.
  virtual void publish() = 0;
  // received, lost, rejected, condition and details as last published. Any thread, one at a time, while the channel's
  // thread is in any of the functions above.
  virtual void describe(JointStreamStatus& status, Timestamp now) = 0;

  // Which frames its nodes take; every frame by default. `member`: its number on the channel.
  virtual void add_routes(std::uint16_t member, IdentifierRoutes& routes) const { routes.add_all({member, 0}); }
  // Another number wherever add_routes() may add other ones.
  [[nodiscard]] virtual std::uint64_t routes_revision() const { return 0; }
};

}  // namespace cellmirror::can
