// Who is at the other end of a TCP connection. For sharing and for records, not for access rights.
#pragma once

#include <string>

namespace cellmirror::web {

// "uid 1000" for a process on this machine; for another machine its IPv4 address, or the /64 network of its IPv6
// address, which is what one machine usually has to itself. "127.0.0.1" where the kernel does not name the user of a
// local process; "unknown" for what is no TCP socket. Asks the kernel (sock_diag(7)); does not wait for the peer.
[[nodiscard]] std::string peer_of(int socket);

}  // namespace cellmirror::web
