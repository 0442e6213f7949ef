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

namespace cellmirror::sim {
namespace {

class ErrorFrameChannel final : public CanChannel {
 public:
  ErrorFrameChannel(std::unique_ptr<CanChannel> channel, int fd) : channel_(std::move(channel)), fd_(fd) {}
  ~ErrorFrameChannel() override { close(fd_); }
  ErrorFrameChannel(const ErrorFrameChannel&) = delete;
  ErrorFrameChannel& operator=(const ErrorFrameChannel&) = delete;

  CanReceive receive(ReceivedCanFrame& frame, Nanoseconds timeout) override {
    return channel_->receive(frame, timeout);
  }

  bool send(const CanFrame& frame) override {
    if (!frame.error) return channel_->send(frame);
    can_frame raw{};
    raw.can_id = (frame.id & CAN_ERR_MASK) | CAN_ERR_FLAG;
    raw.len = kErrorFrameBytes;
    std::copy_n(frame.data.begin(), kErrorFrameBytes, raw.data);
    return ::send(fd_, &raw, sizeof raw, MSG_DONTWAIT) == static_cast<ssize_t>(sizeof raw);
  }

  [[nodiscard]] CanChannelStatus status() const override { return channel_->status(); }

 private:
  static constexpr int kErrorFrameBytes = 8;  // linux/can/error.h

  std::unique_ptr<CanChannel> channel_;
  int fd_;
};

}  // namespace

Result<std::unique_ptr<CanChannel>> with_error_frames(std::unique_ptr<CanChannel> channel,
                                                      const std::string& interface) {
  const int fd = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  if (fd < 0 || bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    const std::string why = std::strerror(errno);
    if (fd >= 0) close(fd);
    return fail(fmt::format("{}: no socket for error frames: {}", interface, why));
  }
  // It only sends.
  setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, nullptr, 0);
  return std::make_unique<ErrorFrameChannel>(std::move(channel), fd);
}

}  // namespace cellmirror::sim
