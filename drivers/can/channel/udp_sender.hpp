// Sends datagrams on a connected UDP socket, several with one call.
#pragma once

#include <sys/uio.h>

#include <span>
#include <utility>

#include "rt_core/base/descriptor.hpp"

namespace cellmirror::can {

class UdpSender {
 public:
  UdpSender() = default;
  explicit UdpSender(Descriptor socket) : socket_(std::move(socket)) {}

  // Never waits. `errors`: as send_messages() fills it. At most kSendBatch datagrams, in their order.
  void send(std::span<iovec> datagrams, std::span<int> errors);

 private:
  // Datagrams of one size, which the kernel cuts apart where they are received or leave the machine: a third of the
  // work, and a receiver wakes once (UDP_SEGMENT). False: nothing was sent.
  [[nodiscard]] bool send_segmented(std::span<iovec> datagrams);
  void send_one_by_one(std::span<iovec> datagrams, std::span<int> errors);

  Descriptor socket_;
  bool can_segment_ = true;  // as far as is known
};

}  // namespace cellmirror::can
