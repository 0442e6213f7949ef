#include "drivers/rtde/tcp_connection.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <chrono>
#include <cstring>

namespace cellmirror::rtde {

namespace {

constexpr std::size_t kMostWaiting = 65536;

Result<socklen_t> fill(const std::string& address, std::uint16_t port, sockaddr_storage& out) {
  auto& v4 = reinterpret_cast<sockaddr_in&>(out);
  auto& v6 = reinterpret_cast<sockaddr_in6&>(out);
  if (inet_pton(AF_INET, address.c_str(), &v4.sin_addr) == 1) {
    v4.sin_family = AF_INET;
    v4.sin_port = htons(port);
    return static_cast<socklen_t>(sizeof(v4));
  }
  if (inet_pton(AF_INET6, address.c_str(), &v6.sin6_addr) == 1) {
    v6.sin6_family = AF_INET6;
    v6.sin6_port = htons(port);
    return static_cast<socklen_t>(sizeof(v6));
  }
  return fail(address + " is not a numeric address");
}

std::unexpected<Error> failed(int error) {
  return fail(std::strerror(error), error == ECONNREFUSED ? "is RTDE enabled on the controller?" : "");
}

}  // namespace

Result<void> TcpConnection::connect(const std::string& address, std::uint16_t port) {
  close();
  sockaddr_storage to{};
  const auto size = fill(address, port, to);
  if (!size) return std::unexpected(size.error());
  socket_ = Descriptor(::socket(to.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!socket_.valid()) return failed(errno);
  const int one = 1;
  ::setsockopt(socket_.get(), IPPROTO_TCP, TCP_NODELAY, &one, sizeof(one));
  if (::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&to), *size) == 0) {
    established_ = true;
  } else if (errno != EINPROGRESS) {
    return failed(errno);
  }
  return {};
}

void TcpConnection::close() {
  socket_.reset();
  established_ = false;
  waiting_.clear();
}

Result<void> TcpConnection::finish_connecting() {
  int error = 0;
  socklen_t size = sizeof(error);
  if (::getsockopt(socket_.get(), SOL_SOCKET, SO_ERROR, &error, &size) != 0) error = errno;
  if (error != 0) return failed(error);
  established_ = true;
  return {};
}

Result<void> TcpConnection::flush() {
  while (established_ && !waiting_.empty()) {
    const ssize_t count = ::send(socket_.get(), waiting_.data(), waiting_.size(), MSG_NOSIGNAL);
    if (count < 0) {
      if (errno == EAGAIN || errno == EINTR) return {};
      return failed(errno);
    }
    waiting_.erase(waiting_.begin(), waiting_.begin() + count);
  }
  return {};
}

Result<std::size_t> TcpConnection::receive(std::span<std::uint8_t> to, Nanoseconds timeout) {
  if (auto sent = flush(); !sent) return std::unexpected(sent.error());
  const bool writes = !established_ || !waiting_.empty();
  pollfd wait{socket_.get(), static_cast<short>(writes ? POLLIN | POLLOUT : POLLIN), 0};
  const int ready = ::poll(&wait, 1, static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(timeout).count()));
  if (ready <= 0) return 0;
  if (!established_) {
    if (auto done = finish_connecting(); !done) return std::unexpected(done.error());
  }
  if (auto sent = flush(); !sent) return std::unexpected(sent.error());
  const ssize_t count = ::recv(socket_.get(), to.data(), to.size(), MSG_DONTWAIT);
  if (count > 0) return static_cast<std::size_t>(count);
  if (count == 0) return fail("the controller ended the connection");
  if (errno == EAGAIN || errno == EINTR) return 0;
  return failed(errno);
}

void TcpConnection::send(std::span<const std::uint8_t> bytes) {
  if (waiting_.size() + bytes.size() <= kMostWaiting) waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
}

}  // namespace cellmirror::rtde
