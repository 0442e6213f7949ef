#include "drivers/can/channel/endpoint.hpp"

#include <arpa/inet.h>
#include <net/if.h>
#include <netinet/in.h>

#include <algorithm>

#include "rt_core/base/text.hpp"

namespace cellmirror::can {
namespace {

constexpr std::string_view kRemedy = "write socketcan:can0, udp:239.74.163.2:43113, udp:[ff15::1]:43113 or log:FILE";

Result<Endpoint> parse_socketcan(std::string_view interface) {
  const bool printable_name =
      std::all_of(interface.begin(), interface.end(), [](char c) { return c > ' ' && c < 0x7F && c != '/'; });
  if (interface.empty() || interface.size() >= IFNAMSIZ || !printable_name) {
    return fail("'" + printable(interface) + "' is no name of a network interface", "name one, e.g. socketcan:can0");
  }
  return SocketCanEndpoint{std::string(interface)};
}

bool is_multicast(const UdpEndpoint& udp) {
  if (udp.ipv6) {
    in6_addr address{};
    return inet_pton(AF_INET6, udp.group.c_str(), &address) == 1 && address.s6_addr[0] == 0xFF;
  }
  in_addr address{};
  return inet_pton(AF_INET, udp.group.c_str(), &address) == 1 && IN_MULTICAST(ntohl(address.s_addr));
}

Result<Endpoint> parse_udp(std::string_view text) {
  UdpEndpoint udp;
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return fail("'udp:" + printable(text) + "' has no port", std::string(kRemedy));
  std::string_view group = text.substr(0, colon);
  const auto port = parse_integer(text.substr(colon + 1));
  if (!port || *port < 1 || *port > 65535) {
    return fail("'" + printable(text.substr(colon + 1)) + "' is no UDP port", "use a port from 1 to 65535");
  }
  udp.port = static_cast<std::uint16_t>(*port);
  if (group.size() >= 2 && group.front() == '[' && group.back() == ']') {
    group = group.substr(1, group.size() - 2);
    udp.ipv6 = true;
  }
  udp.group = std::string(group);
  if (!is_multicast(udp)) {
    return fail("'" + printable(group) + "' is no multicast group",
                "use an IPv4 group of 224.0.0.0/4, or an IPv6 group of ff00::/8 in brackets");
  }
  return udp;
}

}  // namespace

Result<Endpoint> parse_endpoint(std::string_view text) {
  const std::size_t colon = text.find(':');
  const std::string_view kind = text.substr(0, colon);
  const std::string_view rest = colon == std::string_view::npos ? std::string_view{} : text.substr(colon + 1);
  if (kind == "socketcan") return parse_socketcan(rest);
  if (kind == "udp") return parse_udp(rest);
  if (kind == "log") {
    if (rest.empty() || rest.find('\0') != std::string_view::npos)
      return fail("'log:' names no file", std::string(kRemedy));
    return LogEndpoint{std::string(rest)};
  }
  return fail("'" + printable(text) + "' is no CAN channel", std::string(kRemedy));
}

}  // namespace cellmirror::can
