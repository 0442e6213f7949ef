#include "sim_devices/robot/error_frame_channel.hpp"

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "rt_core/base/descriptor.hpp"

namespace cellmirror::sim {
namespace {

class ErrorFrameChannel final : public CanChannel {
 public:
  ErrorFrameChannel(std::unique_ptr<CanChannel> channel, Descriptor socket)
      : channel_(std::move(channel)), socket_(std::move(socket)) {}

  CanReceive receive(ReceivedCanFrame& frame, Nanoseconds timeout) override {
    return channel_->receive(frame, timeout);
  }

  bool send(const CanFrame& frame) override {
    if (!frame.error) return channel_->send(frame);
    can_frame raw{};
    raw.can_id = (frame.id & CAN_ERR_MASK) | CAN_ERR_FLAG;
    raw.len = kErrorFrameBytes;
    std::copy_n(frame.data.begin(), kErrorFrameBytes, raw.data);
    return ::send(socket_.get(), &raw, sizeof raw, MSG_DONTWAIT) == static_cast<ssize_t>(sizeof raw);
  }

  [[nodiscard]] const CanChannelStatus& status() const override { return channel_->status(); }

 private:
  static constexpr int kErrorFrameBytes = 8;  // linux/can/error.h

  std::unique_ptr<CanChannel> channel_;
  Descriptor socket_;
};

}  // namespace

Result<std::unique_ptr<CanChannel>> with_error_frames(std::unique_ptr<CanChannel> channel,
                                                      const std::string& interface) {
  Descriptor sender(socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW));
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  if (!sender.valid() || bind(sender.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return fail(fmt::format("{}: no socket for error frames: {}", interface, std::strerror(errno)));
  }
  // It only sends.
  setsockopt(sender.get(), SOL_CAN_RAW, CAN_RAW_FILTER, nullptr, 0);
  return std::make_unique<ErrorFrameChannel>(std::move(channel), std::move(sender));
}

}  // namespace cellmirror::sim
