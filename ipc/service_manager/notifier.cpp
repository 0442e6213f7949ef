#include "ipc/service_manager/notifier.hpp"

#include <fmt/format.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iterator>

#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

constexpr const char* kSocket = "NOTIFY_SOCKET";
constexpr const char* kTimeout = "WATCHDOG_USEC";
constexpr const char* kProcess = "WATCHDOG_PID";
constexpr timeval kLongestWait{1, 0};  // s, us: a full queue of the service manager must not hold up the gateway

std::optional<std::int64_t> whole_number(std::string_view text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// Takes the variable out of the environment.
std::optional<std::string> take(const char* name) {
  const char* value = std::getenv(name);
  if (value == nullptr) return std::nullopt;
  std::string taken(value);
  unsetenv(name);
  return taken;
}

const char* text_of(const std::optional<std::string>& text) { return text ? text->c_str() : nullptr; }

}  // namespace

Result<NotifyAddress> notify_address(std::string_view text) {
  const bool abstract = text.starts_with('@');
  if (!abstract && !text.starts_with('/'))
    return fail(fmt::format("NOTIFY_SOCKET is {}, which is no address of a Unix socket", printable(text)),
                "a path that begins with / or a name that begins with @");
  NotifyAddress out;
  // A path ends with a NUL byte in the address; the length of an abstract name says where it ends.
  const std::size_t most = sizeof out.address.sun_path - (abstract ? 0 : 1);
  if (text.size() < 2 || text.size() > most)
    return fail(fmt::format("NOTIFY_SOCKET has {} bytes; an address has 2 to {}", text.size(), most));
  out.address.sun_family = AF_UNIX;
  std::ranges::copy(text, std::begin(out.address.sun_path));
  if (abstract) out.address.sun_path[0] = '\0';
  out.length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + text.size() + (abstract ? 0 : 1));
  return out;
}

std::optional<Nanoseconds> watchdog_timeout(const char* usec, const char* pid, pid_t process) {
  if (usec == nullptr) return std::nullopt;
  if (pid != nullptr && whole_number(pid) != process) return std::nullopt;
  const auto number = whole_number(usec);
  constexpr std::int64_t kLongest_us = 1'000'000LL * 3600 * 24 * 365;
  if (!number || *number <= 0 || *number > kLongest_us) return std::nullopt;
  return std::chrono::microseconds(*number);
}

Result<ServiceNotifier> ServiceNotifier::take_from_environment() {
  ServiceNotifier out;
  const auto place = take(kSocket);
  const auto usec = take(kTimeout);
  const auto pid = take(kProcess);
  if (!place) return out;
  auto address = notify_address(*place);
  if (!address) return std::unexpected(address.error());
  out.address_ = *address;
  out.socket_ = Descriptor(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!out.socket_.valid()) return fail(fmt::format("no socket to the service manager: {}", std::strerror(errno)));
  setsockopt(out.socket_.get(), SOL_SOCKET, SO_SNDTIMEO, &kLongestWait, sizeof kLongestWait);
  out.timeout_ = watchdog_timeout(text_of(usec), text_of(pid), getpid());
  return out;
}

Result<void> ServiceNotifier::send(std::string_view lines) const {
  if (!connected()) return {};
  ssize_t sent = -1;
  do {
    sent = sendto(socket_.get(), lines.data(), lines.size(), MSG_NOSIGNAL,
                  reinterpret_cast<const sockaddr*>(&address_.address), address_.length);
  } while (sent < 0 && errno == EINTR);
  if (sent < 0) return fail(fmt::format("the service manager takes no message: {}", std::strerror(errno)));
  return {};
}

std::string status_line(std::string_view text) {
  std::string out = fmt::format("STATUS={}", text);
  std::ranges::replace(out, '\n', ' ');
  return out;
}

}  // namespace cellmirror
