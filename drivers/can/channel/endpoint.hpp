// The text that names a channel in a cell file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "rt_core/base/result.hpp"

namespace cellmirror::can {

struct SocketCanEndpoint {
  std::string interface;
};
struct UdpEndpoint {
  std::string group;  // IPv4 or IPv6 multicast address, without brackets
  std::uint16_t port = 0;
  bool ipv6 = false;
};
struct LogEndpoint {
  std::string file;
};
using Endpoint = std::variant<SocketCanEndpoint, UdpEndpoint, LogEndpoint>;

// Checks the text alone; nothing is opened. Refuses groups that are not multicast addresses.
[[nodiscard]] Result<Endpoint> parse_endpoint(std::string_view text);

}  // namespace cellmirror::can
