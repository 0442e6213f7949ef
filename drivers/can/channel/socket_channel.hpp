// What the channels over sockets share: waiting, batches, re-opening with back-off, moving the kernel's receive stamps
// to our clock.
#pragma once

#include <sys/socket.h>

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

// As large as the machine allows, at most `bytes`; privileged first.
void set_receive_buffer(int fd, int bytes);

// Both clocks read together, to move stamps of CLOCK_REALTIME (SO_TIMESTAMPNS) to the monotonic clock.
struct ClockPair {
  std::int64_t monotonic_ns = 0;
  std::int64_t real_ns = 0;

  [[nodiscard]] static ClockPair read();
  // A stamp that cannot be right (in the future, older than a second) gives the time of the read.
  [[nodiscard]] Timestamp monotonic(std::int64_t stamp_real_ns) const;
};

// What the kernel reports beside the data.
struct Ancillary {
  std::int64_t stamp_real_ns = 0;  // 0: none
  std::uint32_t dropped = 0;       // SO_RXQ_OVFL: since the socket was opened
  bool has_dropped = false;

  [[nodiscard]] static Ancillary of(msghdr& message);
};

inline constexpr std::size_t kReceiveBatch = 32;
inline constexpr std::size_t kSendBatch = 64;
inline constexpr std::size_t kControlCapacity = 128;

// Gives messages to the kernel with as few calls as that takes. `errors`, as long as `messages`: 0, or why the kernel
// did not take it (errno); ENOTCONN where `fd` is not valid.
void send_messages(int fd, std::span<mmsghdr> messages, std::span<int> errors);

class SocketChannel : public CanChannel {
 public:
  CanReceive receive(ReceivedCanFrame& frame, Nanoseconds timeout) final;
  bool send(const CanFrame& frame) final {
    bool sent = false;
    send_all(std::span(&frame, 1), std::span(&sent, 1));
    return sent;
  }
  [[nodiscard]] const CanChannelStatus& status() const final { return status_; }

  // Opens the socket, or starts to wait for a missing interface. Fails where waiting does not help.
  [[nodiscard]] Result<void> open_or_wait();

 protected:
  SocketChannel() = default;

  // Opens or re-opens; leaves `socket_` closed on failure. Names a missing interface that may appear later in
  // `status_.waits_for`.
  [[nodiscard]] virtual Result<void> open_socket() = 0;
  // Takes what has arrived into the batch, without waiting. False: the socket is of no use any more.
  [[nodiscard]] virtual bool fill() = 0;
  // Why the kernel did not take a frame (errno).
  virtual void refuse(int error) = 0;
  // Counts what was sent and what was not, as send_messages() tells it, and tells it by `sent`.
  void count_sent(std::span<const int> errors, std::span<bool> sent);
  // Called every half second: whether the interface is still the one that was opened. False: re-open.
  [[nodiscard]] virtual bool is_current() = 0;

  void put(const CanFrame& frame, Timestamp receive_time);
  // Counts and remembers the kernel's drop counter.
  void note_dropped(const Ancillary& ancillary);
  void go_down(const std::string& why);
  // Counts a frame that was not sent. Why the channel is down stays what is shown.
  void note_refused(const std::string& why);

  Descriptor socket_;
  CanChannelStatus status_;
  SystemClock clock_;

 private:
  void reopen_when_due(Timestamp now);
  void wait_for_what_is_missing(const Error& error);
  void check_interface(Timestamp now);
  void wait(Nanoseconds time);
  [[nodiscard]] bool give(ReceivedCanFrame& frame);

  std::array<ReceivedCanFrame, kReceiveBatch> batch_;
  std::size_t batch_size_ = 0;
  std::size_t next_ = 0;
  Timestamp next_try_;
  Nanoseconds back_off_{0};
  Timestamp next_check_;
  std::uint32_t last_dropped_ = 0;
};

}  // namespace cellmirror::can
