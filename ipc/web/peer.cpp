#include "ipc/web/peer.hpp"

#include <arpa/inet.h>
#include <linux/inet_diag.h>
#include <linux/netlink.h>
#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>

#include "rt_core/base/descriptor.hpp"

namespace cellmirror::web {

namespace {

struct Endpoint {
  int family = 0;
  std::uint16_t port = 0;                  // network byte order
  std::array<std::uint8_t, 16> address{};  // an IPv4 address in the first four
  [[nodiscard]] std::size_t bytes() const { return family == AF_INET6 ? 16 : 4; }
};

std::optional<Endpoint> endpoint_of(const sockaddr_storage& storage) {
  Endpoint out;
  out.family = storage.ss_family;
  if (out.family == AF_INET) {
    sockaddr_in four{};
    std::memcpy(&four, &storage, sizeof four);
    out.port = four.sin_port;
    std::memcpy(out.address.data(), &four.sin_addr, sizeof four.sin_addr);
    return out;
  }
  if (out.family != AF_INET6) return std::nullopt;
  sockaddr_in6 six{};
  std::memcpy(&six, &storage, sizeof six);
  out.port = six.sin6_port;
  std::memcpy(out.address.data(), &six.sin6_addr, sizeof six.sin6_addr);
  return out;
}

using NameOf = int (*)(int, sockaddr*, socklen_t*);
std::optional<Endpoint> endpoint(int socket, NameOf name_of) {
  sockaddr_storage storage{};
  socklen_t length = sizeof storage;
  if (name_of(socket, reinterpret_cast<sockaddr*>(&storage), &length) != 0) return std::nullopt;
  return endpoint_of(storage);
}

bool on_this_machine(const Endpoint& peer, const Endpoint& own) {
  if (peer.address == own.address) return true;
  if (peer.family == AF_INET) return peer.address[0] == 127;
  in6_addr address{};
  std::memcpy(&address, peer.address.data(), sizeof address);
  return IN6_IS_ADDR_LOOPBACK(&address);
}

std::string text_of(const Endpoint& peer) {
  constexpr std::size_t kNetworkBytes = 8;  // of 64 bits
  Endpoint shown = peer;
  const bool six = peer.family == AF_INET6;
  if (six) std::fill(shown.address.begin() + kNetworkBytes, shown.address.end(), std::uint8_t{0});
  std::array<char, INET6_ADDRSTRLEN> text{};
  ::inet_ntop(peer.family, shown.address.data(), text.data(), text.size());
  return six ? std::string(text.data()) + "/64" : std::string(text.data());
}

struct DiagRequest {
  nlmsghdr header{};
  inet_diag_req_v2 question{};
};

// The user who owns the peer's end of the connection, which is a socket of this machine too.
std::optional<std::uint32_t> user_of(const Endpoint& peer, const Endpoint& own) {
  const Descriptor netlink(::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_SOCK_DIAG));
  if (!netlink.valid()) return std::nullopt;
  DiagRequest request;
  request.header.nlmsg_len = sizeof request;
  request.header.nlmsg_type = SOCK_DIAG_BY_FAMILY;
  request.header.nlmsg_flags = NLM_F_REQUEST;
  request.question.sdiag_family = static_cast<std::uint8_t>(peer.family);
  request.question.sdiag_protocol = IPPROTO_TCP;
  request.question.idiag_states = ~0U;
  request.question.id.idiag_sport = peer.port;
  request.question.id.idiag_dport = own.port;
  std::memcpy(request.question.id.idiag_src, peer.address.data(), peer.bytes());
  std::memcpy(request.question.id.idiag_dst, own.address.data(), own.bytes());
  std::ranges::fill(request.question.id.idiag_cookie, INET_DIAG_NOCOOKIE);
  // The kernel answers within the call of send().
  if (::send(netlink.get(), &request, sizeof request, 0) != static_cast<ssize_t>(sizeof request)) return std::nullopt;
  struct {
    nlmsghdr header{};
    inet_diag_msg answer{};
    std::array<char, 1024> attributes{};
  } got;
  const ssize_t bytes = ::recv(netlink.get(), &got, sizeof got, MSG_DONTWAIT);
  const auto least = static_cast<ssize_t>(offsetof(decltype(got), attributes));
  if (bytes < least || got.header.nlmsg_type != SOCK_DIAG_BY_FAMILY) return std::nullopt;
  return got.answer.idiag_uid;
}

}  // namespace

std::string peer_of(int socket) {
  const auto peer = endpoint(socket, ::getpeername);
  const auto own = endpoint(socket, ::getsockname);
  if (!peer || !own) return "unknown";
  if (on_this_machine(*peer, *own)) {
    if (const auto user = user_of(*peer, *own)) return "uid " + std::to_string(*user);
  }
  return text_of(*peer);
}

}  // namespace cellmirror::web
