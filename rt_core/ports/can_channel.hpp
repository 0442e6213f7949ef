// A CAN controller as the protocols see it: frames in, frames out, and the health of the bus.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

inline constexpr std::size_t kCanMaxData = 64;

// One classic or FD frame. Data beyond `length` is zero.
struct CanFrame {
  std::uint32_t id = 0;  // 11 or 29 bits, without flags
  bool extended = false;
  bool remote = false;
  bool error = false;  // an error frame of SocketCAN: `id` holds the CAN_ERR_* classes
  bool fd = false;
  bool bit_rate_switch = false;
  bool error_state_indicator = false;
  std::uint8_t length = 0;  // bytes of data
  std::array<std::uint8_t, kCanMaxData> data{};

  [[nodiscard]] std::span<const std::uint8_t> payload() const { return {data.data(), length}; }
};

struct ReceivedCanFrame {
  CanFrame frame;
  Timestamp receive_time;
};

enum class CanBusState : std::uint8_t { unknown, active, warning, passive, bus_off, down };

// Counters of a channel since it was opened.
struct CanChannelStatus {
  CanBusState bus = CanBusState::unknown;
  std::uint64_t received = 0;
  std::uint64_t sent = 0;
  std::uint64_t send_refused = 0;     // ENOBUFS and the like: the frame was not sent
  std::uint64_t receive_dropped = 0;  // as reported by the kernel (SO_RXQ_OVFL)
  std::uint64_t malformed = 0;        // datagrams or log lines that are no frames
  std::uint64_t foreign = 0;          // datagrams of senders that allow_from does not name
  std::uint64_t error_frames = 0;
  std::uint64_t reopened = 0;  // number of recoveries
  std::string last_error;
  std::string waits_for;  // the missing interface, before the first opening or after a loss; empty: none
};

// `again`: a log starts another pass; its frames are unrelated to those before.
enum class CanReceive : std::uint8_t { frame, timeout, down, end, again };

// All calls on one thread at a time. The channel recovers from ENETDOWN, a removed interface and the like: meanwhile
// receive() returns `down` (after its timeout) and send() refuses.
class CanChannel {
 public:
  virtual ~CanChannel() = default;
  // Waits for the next frame, at most `timeout`. `end`: a log was played to its end. `again`: once at the
  // beginning of each pass after the first.
  virtual CanReceive receive(ReceivedCanFrame& frame, Nanoseconds timeout) = 0;
  // Never waits. False where the frame could not be sent (counted).
  virtual bool send(const CanFrame& frame) = 0;
  // The same for several in their order, in one go where the channel can; `sent` is as long as `frames`.
  virtual void send_all(std::span<const CanFrame> frames, std::span<bool> sent) {
    for (std::size_t i = 0; i < frames.size(); ++i) sent[i] = send(frames[i]);
  }
  // Valid until the next call. Takes no lock: who needs it on another thread publishes a copy.
  [[nodiscard]] virtual const CanChannelStatus& status() const = 0;
};

}  // namespace cellmirror
