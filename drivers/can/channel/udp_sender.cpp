#include "drivers/can/channel/udp_sender.hpp"

#include <netinet/in.h>
#include <netinet/udp.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>

#include "drivers/can/channel/socket_channel.hpp"
#include "rt_core/base/contract.hpp"

namespace cellmirror::can {

void UdpSender::send(std::span<iovec> datagrams, std::span<int> errors) {
  CELLMIRROR_EXPECTS(datagrams.size() <= kSendBatch && errors.size() == datagrams.size());
  for (std::size_t first = 0; first < datagrams.size();) {
    const std::size_t size = datagrams[first].iov_len;
    std::size_t count = 1;
    while (first + count < datagrams.size() && datagrams[first + count].iov_len == size) ++count;
    const std::span<iovec> run = datagrams.subspan(first, count);
    if (count > 1 && send_segmented(run)) {
      std::ranges::fill(errors.subspan(first, count), 0);
    } else {
      send_one_by_one(run, errors.subspan(first, count));
    }
    first += count;
  }
}

void UdpSender::send_one_by_one(std::span<iovec> datagrams, std::span<int> errors) {
  std::array<mmsghdr, kSendBatch> messages;
  for (std::size_t i = 0; i < datagrams.size(); ++i) {
    messages[i] = {};
    messages[i].msg_hdr.msg_iov = &datagrams[i];
    messages[i].msg_hdr.msg_iovlen = 1;
  }
  send_messages(socket_.get(), std::span(messages).first(datagrams.size()), errors);
}

bool UdpSender::send_segmented(std::span<iovec> datagrams) {
  if (!can_segment_ || !socket_.valid()) return false;
  const auto size = static_cast<std::uint16_t>(datagrams.front().iov_len);
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof size)> control{};
  msghdr message{};
  message.msg_iov = datagrams.data();
  message.msg_iovlen = datagrams.size();
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  cmsghdr* option = CMSG_FIRSTHDR(&message);
  option->cmsg_level = SOL_UDP;
  option->cmsg_type = UDP_SEGMENT;
  option->cmsg_len = CMSG_LEN(sizeof size);
  std::memcpy(CMSG_DATA(option), &size, sizeof size);
  const ssize_t written = sendmsg(socket_.get(), &message, MSG_DONTWAIT);
  if (written == static_cast<ssize_t>(size * datagrams.size())) return true;
  // Old kernels, and interfaces that compute no checksums.
  if (errno == EINVAL || errno == EIO) can_segment_ = false;
  return false;
}

}  // namespace cellmirror::can
