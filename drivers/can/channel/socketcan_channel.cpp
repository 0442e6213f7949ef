#include "drivers/can/channel/socketcan_channel.hpp"

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "drivers/can/channel/error_frame.hpp"
#include "drivers/can/channel/socket_channel.hpp"

namespace cellmirror::can {
namespace {

constexpr std::uint8_t kFdLengths[] = {8, 12, 16, 20, 24, 32, 48, 64};
constexpr int kReceiveBuffer = 8'000'000;  // bytes: some 10,000 frames with the kernel's book-keeping

CanFrame from_kernel(const canfd_frame& raw, std::size_t bytes) {
  CanFrame frame;
  frame.fd = bytes == CANFD_MTU;
  frame.error = (raw.can_id & CAN_ERR_FLAG) != 0;
  frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.id = raw.can_id & (frame.extended || frame.error ? CAN_EFF_MASK : CAN_SFF_MASK);
  if (frame.error) frame.id = raw.can_id & CAN_ERR_MASK;
  frame.length = static_cast<std::uint8_t>(std::min<std::size_t>(raw.len, frame.fd ? kCanMaxData : 8));
  if (frame.fd) {
    frame.bit_rate_switch = (raw.flags & CANFD_BRS) != 0;
    frame.error_state_indicator = (raw.flags & CANFD_ESI) != 0;
  }
  if (!frame.remote) std::copy_n(raw.data, frame.length, frame.data.begin());
  return frame;
}

// The length that a controller can send: FD frames have steps above 8 bytes.
std::uint8_t sendable_length(const CanFrame& frame) {
  if (!frame.fd) return std::min<std::uint8_t>(frame.length, 8);
  for (const std::uint8_t step : kFdLengths) {
    if (frame.length <= step) return frame.length <= 8 ? frame.length : step;
  }
  return kCanMaxData;
}

canfd_frame to_kernel(const CanFrame& frame) {
  canfd_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) | (frame.remote ? CAN_RTR_FLAG : 0U);
  raw.len = sendable_length(frame);
  if (frame.fd) {
    raw.flags = static_cast<std::uint8_t>((frame.bit_rate_switch ? CANFD_BRS : 0) |
                                          (frame.error_state_indicator ? CANFD_ESI : 0));
  }
  std::copy_n(frame.data.begin(), frame.length, raw.data);
  return raw;
}

// A command creates a virtual interface; a real one appears with its adapter, and must not be created by hand.
std::string remedy_for_missing(const std::string& interface) {
  if (interface.starts_with("vcan"))
    return fmt::format("create it: 'ip link add {} type vcan && ip link set {} up'", interface, interface);
  return "connect the adapter or load its driver; 'ip link show type can' lists the CAN interfaces";
}

// The reason for which the kernel refused a frame, and the remedy.
std::string send_problem(const std::string& interface, int error) {
  if (error != ENOBUFS) return fmt::format("send: {}", std::strerror(error));
  return fmt::format(
      "the transmit queue of {} is full: no node acknowledges, the bus is too slow for the traffic, or the queue is "
      "too "
      "short ('ip link set {} txqueuelen 1000')",
      interface, interface);
}

// What reading and sending say when the interface of a bound socket was removed.
bool is_gone(int error) { return error == ENODEV || error == ENXIO; }

class SocketCanChannel final : public SocketChannel {
 public:
  explicit SocketCanChannel(std::string interface) : interface_(std::move(interface)) {}

  [[nodiscard]] Result<void> open_socket() override;
  void send_all(std::span<const CanFrame> frames, std::span<bool> sent) override;

 private:
  [[nodiscard]] bool fill() override;
  void refuse(int error) override;
  [[nodiscard]] bool is_current() override;
  void take(const canfd_frame& raw, std::size_t bytes, Timestamp receive_time);
  [[nodiscard]] bool is_up() const;
  [[nodiscard]] std::string switched_off() const;
  [[nodiscard]] std::string removed() const { return "the interface " + interface_ + " was removed"; }

  std::string interface_;
  unsigned index_ = 0;
};

Result<void> SocketCanChannel::open_socket() {
  status_.waits_for.clear();
  Descriptor fd(socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW));
  if (!fd.valid()) {
    if (errno == EAFNOSUPPORT || errno == EPROTONOSUPPORT) {
      status_.waits_for = interface_;  // the module may be loaded later
      return fail("this kernel has no CAN (AF_CAN)",
                  "load it with 'modprobe can_raw', boot a kernel that has it, or use a udp: or log: channel");
    }
    return fail(fmt::format("no CAN socket: {}", std::strerror(errno)), "check the permissions of this program");
  }
  index_ = if_nametoindex(interface_.c_str());
  if (index_ == 0) {
    status_.waits_for = interface_;
    return fail("there is no network interface " + interface_, remedy_for_missing(interface_));
  }
  const int on = 1;
  const can_err_mask_t errors = CAN_ERR_MASK;
  setsockopt(fd.get(), SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on);
  setsockopt(fd.get(), SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors);
  setsockopt(fd.get(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
  setsockopt(fd.get(), SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
  set_receive_buffer(fd.get(), kReceiveBuffer);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(index_);
  if (bind(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    if (errno == ENODEV)
      return fail(interface_ + " is no CAN interface", "name one that 'ip -details link' shows as can or vcan");
    status_.waits_for = interface_;
    return fail(fmt::format("cannot bind to {}: {}", interface_, std::strerror(errno)));
  }
  socket_ = std::move(fd);
  if (is_up()) {
    status_.bus = CanBusState::active;
  } else {
    go_down(switched_off());
  }
  return {};
}

bool SocketCanChannel::is_up() const {
  ifreq request{};
  interface_.copy(request.ifr_name, IFNAMSIZ - 1);
  return ioctl(socket_.get(), SIOCGIFFLAGS, &request) == 0 && (request.ifr_flags & IFF_UP) != 0;
}

bool SocketCanChannel::is_current() {
  if (if_nametoindex(interface_.c_str()) != index_) {
    go_down(removed());
    return false;
  }
  const bool up = is_up();
  if (up && status_.bus == CanBusState::down) status_.bus = CanBusState::active;
  if (!up && status_.bus != CanBusState::down) go_down(switched_off());
  return true;
}

std::string SocketCanChannel::switched_off() const {
  return fmt::format("the interface {} is down: 'ip link set {} up'", interface_, interface_);
}

bool SocketCanChannel::fill() {
  std::array<canfd_frame, kReceiveBatch> raw;
  std::array<iovec, kReceiveBatch> buffers;
  std::array<std::array<char, kControlCapacity>, kReceiveBatch> control;
  std::array<mmsghdr, kReceiveBatch> messages{};
  for (std::size_t i = 0; i < kReceiveBatch; ++i) {
    buffers[i] = {&raw[i], sizeof raw[i]};
    messages[i].msg_hdr.msg_iov = &buffers[i];
    messages[i].msg_hdr.msg_iovlen = 1;
    messages[i].msg_hdr.msg_control = control[i].data();
    messages[i].msg_hdr.msg_controllen = control[i].size();
  }
  const int count = recvmmsg(socket_.get(), messages.data(), kReceiveBatch, MSG_DONTWAIT, nullptr);
  if (count < 0) {
    if (errno == EAGAIN || errno == EINTR) return true;
    const int error = errno;
    go_down(error == ENETDOWN ? switched_off()
            : is_gone(error)  ? removed()
                              : fmt::format("{}: {}", interface_, std::strerror(error)));
    return error == ENETDOWN;  // the socket stays bound and hears again when the interface is up
  }
  const ClockPair clocks = ClockPair::read();
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Ancillary ancillary = Ancillary::of(messages[k].msg_hdr);
    note_dropped(ancillary);
    take(raw[k], messages[k].msg_len, clocks.monotonic(ancillary.stamp_real_ns));
  }
  return true;
}

void SocketCanChannel::take(const canfd_frame& raw, std::size_t bytes, Timestamp receive_time) {
  if (bytes != CAN_MTU && bytes != CANFD_MTU) {
    ++status_.malformed;
    return;
  }
  const CanFrame frame = from_kernel(raw, bytes);
  if (frame.error) {
    ++status_.error_frames;
    status_.last_error = error_words(frame);
    if (const auto bus = bus_state_of_error(frame)) status_.bus = *bus;
  } else {
    // A frame proves that the bus is not off and the interface not down.
    const CanBusState bus = status_.bus;
    const bool back = bus == CanBusState::bus_off || bus == CanBusState::down || bus == CanBusState::unknown;
    if (back) status_.bus = CanBusState::active;
    ++status_.received;
  }
  put(frame, receive_time);
}

void SocketCanChannel::send_all(std::span<const CanFrame> frames, std::span<bool> sent) {
  std::array<canfd_frame, kSendBatch> raw;
  std::array<iovec, kSendBatch> buffers;
  std::array<mmsghdr, kSendBatch> messages;
  std::array<int, kSendBatch> errors;
  for (std::size_t done = 0; done < frames.size();) {
    if (frames[done].error) {  // a controller's to send
      refuse(EINVAL);
      sent[done++] = false;
      continue;
    }
    std::size_t count = 0;
    for (; count < kSendBatch && done + count < frames.size() && !frames[done + count].error; ++count) {
      const CanFrame& frame = frames[done + count];
      raw[count] = to_kernel(frame);
      buffers[count] = {&raw[count], frame.fd ? CANFD_MTU : CAN_MTU};
      messages[count] = {};
      messages[count].msg_hdr.msg_iov = &buffers[count];
      messages[count].msg_hdr.msg_iovlen = 1;
    }
    send_messages(socket_.get(), std::span(messages).first(count), std::span(errors).first(count));
    count_sent(std::span(errors).first(count), sent.subspan(done, count));
    done += count;
  }
}

void SocketCanChannel::refuse(int error) {
  if (error == ENETDOWN) go_down(switched_off());
  if (is_gone(error)) go_down(removed());
  note_refused(send_problem(interface_, error));
}

}  // namespace

Result<std::unique_ptr<CanChannel>> open_socketcan_channel(const std::string& interface, bool waits) {
  auto channel = std::make_unique<SocketCanChannel>(interface);
  if (const auto opened = waits ? channel->open_or_wait() : channel->open_socket(); !opened)
    return std::unexpected(opened.error());
  return channel;
}

}  // namespace cellmirror::can
