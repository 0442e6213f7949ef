// Proves to the service manager that the loop runs. Where the proof stays away for WatchdogSec= of the unit, the
// service manager ends the process and starts it again.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <thread>

#include "ipc/service_manager/notifier.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/rt/wake_signal.hpp"

namespace cellmirror {

// Whether a counter has moved since the last look. No thread, no clock.
class Progress {
 public:
  // The first look is progress if anything was counted.
  bool look(std::uint64_t count) {
    const bool moved = count != last_;
    last_ = count;
    return moved;
  }

 private:
  std::uint64_t last_ = 0;
};

// A thread that looks at a counter four times a timeout and sends WATCHDOG=1 each time that it has moved: not when time
// has passed, but when work was done.
class ServiceWatchdog {
 public:
  // `notifier` outlives this, as does what `count` looks at: the cycles that the loop has run. No thread where the
  // service manager does not watch.
  ServiceWatchdog(const ServiceNotifier& notifier, std::function<std::uint64_t()> count);
  ~ServiceWatchdog();
  ServiceWatchdog(const ServiceWatchdog&) = delete;
  ServiceWatchdog& operator=(const ServiceWatchdog&) = delete;

 private:
  void watch(const std::stop_token& stop, Nanoseconds every);

  const ServiceNotifier& notifier_;
  std::function<std::uint64_t()> count_;
  WakeSignal wake_;
  std::jthread thread_;  // last: it uses everything above
};

}  // namespace cellmirror
