#include "drivers/mqtt/process/tcp_probe.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>

#include "rt_core/base/descriptor.hpp"

namespace cellmirror::mqtt {

namespace {

constexpr int kMostAddresses = 8;
constexpr Nanoseconds kLook{100'000'000};

// 0, or the reason why not as errno has it.
int try_to_connect(const addrinfo& address, Nanoseconds limit) {
  const Descriptor socket(
      ::socket(address.ai_family, address.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, address.ai_protocol));
  if (!socket.valid()) return errno;
  if (::connect(socket.get(), address.ai_addr, address.ai_addrlen) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  for (Nanoseconds waited{0}; waited < limit; waited += kLook) {
    pollfd wait{socket.get(), POLLOUT, 0};
    const timespec look{0, kLook.count()};
    if (::ppoll(&wait, 1, &look, nullptr) <= 0) continue;
    int error = 0;
    socklen_t size = sizeof error;
    if (::getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &error, &size) != 0) return errno;
    return error;
  }
  return ETIMEDOUT;
}

std::string numeric(const addrinfo& address) {
  std::array<char, NI_MAXHOST> text{};
  const int error =
      ::getnameinfo(address.ai_addr, address.ai_addrlen, text.data(), text.size(), nullptr, 0, NI_NUMERICHOST);
  return error == 0 ? std::string(text.data()) : std::string();
}

}  // namespace

Result<std::string> answering_address(const std::string& host, std::uint16_t port, Nanoseconds each) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found); error != 0)
    return fail(fmt::format("the name {} has no address: {}", host, ::gai_strerror(error)),
                "correct broker in [mqtt], or give its numeric address");
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> addresses(found, &::freeaddrinfo);
  int reason = ETIMEDOUT;
  int tried = 0;
  for (const addrinfo* at = addresses.get(); at != nullptr && tried < kMostAddresses; at = at->ai_next, ++tried) {
    reason = try_to_connect(*at, each);
    if (reason == 0) return numeric(*at);
  }
  return fail(std::strerror(reason), "start the broker, or correct broker and port in [mqtt]");
}

}  // namespace cellmirror::mqtt
