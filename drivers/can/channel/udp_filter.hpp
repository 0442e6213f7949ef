// A filter of the kernel for datagrams of a multicast group. Pure.
#pragma once

#include <linux/filter.h>
#include <sys/socket.h>

#include <vector>

namespace cellmirror::can {

// For SO_ATTACH_FILTER of a UDP socket: takes all datagrams but those of `sender`, an IPv4 or IPv6 address with port.
// Multicast brings back what a channel sends itself; without the filter each of those would wake its thread.
[[nodiscard]] std::vector<sock_filter> filter_without(const sockaddr_storage& sender);

}  // namespace cellmirror::can
