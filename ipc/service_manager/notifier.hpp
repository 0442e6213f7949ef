// Messages to the service manager that started this process: sd_notify(3), the section "Notes" of which describes the
// protocol. Not for the tick.
#pragma once

#include <sys/socket.h>
#include <sys/types.h>
#include <sys/un.h>

#include <optional>
#include <string>
#include <string_view>

#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

// The socket's address of $NOTIFY_SOCKET: an absolute path, or '@' and a name of the abstract namespace. Pure.
struct NotifyAddress {
  sockaddr_un address{};
  socklen_t length = 0;  // bytes of `address` that count
};
[[nodiscard]] Result<NotifyAddress> notify_address(std::string_view text);

// How often the service manager wants to hear from `process`: $WATCHDOG_USEC, unless $WATCHDOG_PID is another process.
// Nothing where it does not want to, or where the texts are no numbers. Null: not set. Pure.
[[nodiscard]] std::optional<Nanoseconds> watchdog_timeout(const char* usec, const char* pid, pid_t process);

class ServiceNotifier {
 public:
  // Of the environment. It takes NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID out of it, so that no child process
  // speaks for this one; therefore only while the process has one thread. Without NOTIFY_SOCKET, as on a terminal, it
  // gives a notifier that sends nothing. Fails where the address is none.
  [[nodiscard]] static Result<ServiceNotifier> take_from_environment();
  // Sends nothing.
  ServiceNotifier() = default;

  // Lines NAME=VALUE: "READY=1", "STOPPING=1", "STATUS=one line". Waits a second at most. Any thread.
  [[nodiscard]] Result<void> send(std::string_view lines) const;
  // Nothing: the service manager does not watch.
  [[nodiscard]] std::optional<Nanoseconds> timeout() const { return timeout_; }
  [[nodiscard]] bool connected() const { return socket_.valid(); }

 private:
  Descriptor socket_;
  NotifyAddress address_;
  std::optional<Nanoseconds> timeout_;
};

// "STATUS=" and `text` in one line, as send() takes it.
[[nodiscard]] std::string status_line(std::string_view text);

}  // namespace cellmirror
