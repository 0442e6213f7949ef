#include "ipc/service_manager/service_watchdog.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "rt_core/base/log.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror {

namespace {

constexpr Nanoseconds kShortestWait = std::chrono::milliseconds(1);
constexpr int kLooksPerTimeout = 4;

}  // namespace

ServiceWatchdog::ServiceWatchdog(const ServiceNotifier& notifier, std::function<std::uint64_t()> count)
    : notifier_(notifier), count_(std::move(count)) {
  const auto timeout = notifier.timeout();
  if (!timeout || !notifier.connected()) return;
  const Nanoseconds every = std::max(*timeout / kLooksPerTimeout, kShortestWait);
  thread_ = std::jthread([this, every](const std::stop_token& stop) { watch(stop, every); });
}

ServiceWatchdog::~ServiceWatchdog() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  wake_.wake();
  thread_.join();
}

void ServiceWatchdog::watch(const std::stop_token& stop, Nanoseconds every) {
  set_thread_name("service-watch");
  Progress progress;
  while (!stop.stop_requested()) {
    if (!progress.look(count_())) {
      log_error("service-watchdog", "the loop has not run for {:.1f} s; the service manager is not told that it does",
                seconds(every));
    } else if (const auto sent = notifier_.send("WATCHDOG=1"); !sent) {
      log_warning("service-watchdog", "{}", sent.error().text());
    }
    wake_.wait(every);
  }
}

}  // namespace cellmirror
