#include "ipc/control/control_client.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <thread>

#include "ipc/control/control_request.hpp"
#include "ipc/control/control_server.hpp"
#include "ipc/control/instance.hpp"
#include "ipc/control/unix_address.hpp"
#include "ipc/runtime/system_error.hpp"
#include "rt_core/base/descriptor.hpp"

namespace cellmirror {
namespace {

class RequestExchange {
 public:
  RequestExchange(std::string_view who, Nanoseconds timeout)
      : who_(who), timeout_(timeout), deadline_(SystemClock().now() + timeout) {}

  Result<std::string> run(const std::filesystem::path& path, std::string line) {
    if (const auto connected = connect(path); !connected) return std::unexpected(connected.error());
    line += '\n';
    if (const auto sent = send(line); !sent) return std::unexpected(sent.error());
    auto answer = receive();
    if (!answer) return answer;
    if (const auto refused = control_error_in(*answer)) return std::unexpected(*refused);
    return answer;
  }

 private:
  [[nodiscard]] int left_ms() const {
    const std::int64_t left = (deadline_ - SystemClock().now()).count() / 1'000'000;
    return static_cast<int>(std::clamp<std::int64_t>(left, 0, 3'600'000));
  }
  [[nodiscard]] std::unexpected<Error> too_late() const {
    return fail(fmt::format("the gateway of the instance {} did not answer within {:g} s", who_, seconds(timeout_)),
                "check its log; kill -9 ends a blocked gateway, and the next start works");
  }
  [[nodiscard]] std::unexpected<Error> failure(int reason) const {
    switch (reason) {
      case ENOENT:
      case ECONNREFUSED:
        return not_running(who_);
      case EACCES:
      case EPERM:
        return fail(fmt::format("the gateway of the instance {} belongs to another user", who_),
                    "run this as that user");
      default:
        return fail(fmt::format("the gateway of the instance {}: {}", who_, system_error_text(reason)));
    }
  }
  // Waits until the socket is ready for `events`; false when the time is over.
  [[nodiscard]] bool ready(short events) const {
    pollfd polled{socket_.get(), events, 0};
    while (true) {
      const int found = ::poll(&polled, 1, left_ms());
      if (found > 0) return true;
      if (found == 0 || errno != EINTR) return false;
    }
  }

  Result<void> connect(const std::filesystem::path& path) {
    const auto address = unix_address(path);
    if (!address) return std::unexpected(address.error());
    socket_ = Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!socket_.valid()) return failure(errno);
    while (::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof *address) != 0) {
      const int reason = errno;
      // EAGAIN: the kernel's queue of connections to this gateway is full; poll cannot wait for it.
      if (reason != EAGAIN && reason != EINTR) return failure(reason);
      if (left_ms() == 0) return too_late();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return {};
  }

  Result<void> send(std::string_view text) {
    while (!text.empty()) {
      if (!ready(POLLOUT)) return too_late();
      const ssize_t sent = ::send(socket_.get(), text.data(), text.size(), MSG_NOSIGNAL);
      if (sent < 0 && errno != EAGAIN && errno != EINTR) {
        // It may have refused and closed: what it said is still to be read.
        if (errno == EPIPE || errno == ECONNRESET) return {};
        return failure(errno);
      }
      if (sent > 0) text.remove_prefix(static_cast<std::size_t>(sent));
    }
    return {};
  }

  // Until the gateway closes; a complete answer ends with a line break.
  Result<std::string> receive() {
    std::string answer;
    std::array<char, 65536> chunk;
    while (answer.size() <= kMaxControlReplyBytes) {
      if (!ready(POLLIN)) return too_late();
      const ssize_t got = ::recv(socket_.get(), chunk.data(), chunk.size(), 0);
      if (got < 0 && (errno == EAGAIN || errno == EINTR)) continue;
      if (got < 0 && errno != ECONNRESET) return failure(errno);
      if (got <= 0) break;
      answer.append(chunk.data(), static_cast<std::size_t>(got));
    }
    if (!answer.ends_with('\n')) {
      return fail(
          fmt::format("the answer of the gateway of the instance {} was truncated after {} bytes", who_, answer.size()),
          "retry; it may just have ended");
    }
    answer.pop_back();
    return answer;
  }

  std::string who_;
  Nanoseconds timeout_;
  Timestamp deadline_;
  Descriptor socket_;
};

}  // namespace

Result<std::string> control_request(std::string_view instance, std::string_view request, Nanoseconds timeout) {
  const auto socket = control_socket_of(instance);
  if (!socket) return std::unexpected(socket.error());
  return control_request_at(*socket, instance, request, timeout);
}

Result<std::string> control_request_at(const std::filesystem::path& socket, std::string_view who,
                                       std::string_view request, Nanoseconds timeout) {
  return RequestExchange(who, timeout).run(socket, std::string(request));
}

}  // namespace cellmirror
