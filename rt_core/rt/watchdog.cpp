#include "rt_core/rt/watchdog.hpp"

#include <utility>

#include "rt_core/base/contract.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror {

Watchdog::Watchdog(Nanoseconds timeout, std::function<void(const WatchdogFault&)> on_fault)
    : timeout_(timeout), on_fault_(std::move(on_fault)) {
  CELLMIRROR_EXPECTS(timeout.count() > 0);
}

bool Watchdog::check(Timestamp now) {
  WatchdogFault fault;
  {
    const std::lock_guard lock(mutex_);
    if (!armed_) {
      return true;
    }
    const bool checker_was_late = now - last_check_ > timeout_ / 2;
    last_check_ = now;
    if (fault_) {
      return false;
    }
    const std::uint64_t beats = beats_.load(std::memory_order_relaxed);
    if (beats != seen_beats_ || checker_was_late) {
      seen_beats_ = beats;
      last_change_ = now;
      return true;
    }
    if (now - last_change_ <= timeout_) {
      return true;
    }
    fault = WatchdogFault{.noticed = now, .silence = now - last_change_, .beats = beats};
    fault_ = fault;
    faulted_.store(true, std::memory_order_relaxed);
    faults_.fetch_add(1, std::memory_order_relaxed);
  }
  if (on_fault_) {
    on_fault_(fault);  // outside the lock: it may ask for fault() or reset()
  }
  return false;
}

void Watchdog::arm(Timestamp now) {
  const std::lock_guard lock(mutex_);
  armed_ = true;
  seen_beats_ = beats_.load(std::memory_order_relaxed);
  last_change_ = now;
  last_check_ = now;
}

void Watchdog::disarm() {
  const std::lock_guard lock(mutex_);
  armed_ = false;
}

void Watchdog::reset(Timestamp now) {
  const std::lock_guard lock(mutex_);
  fault_.reset();
  faulted_.store(false, std::memory_order_relaxed);
  seen_beats_ = beats_.load(std::memory_order_relaxed);
  last_change_ = now;
  last_check_ = now;
}

std::optional<WatchdogFault> Watchdog::fault() const {
  const std::lock_guard lock(mutex_);
  return fault_;
}

WatchdogThread::WatchdogThread(Watchdog& watchdog, const Clock& clock) : watchdog_(watchdog), clock_(clock) {
  watchdog_.arm(clock_.now());
  thread_ = std::jthread([this](const std::stop_token& stop) {
    set_thread_name("watchdog");
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
      wake_.wait_for(lock, stop, watchdog_.timeout() / 4, [] { return false; });
      if (!stop.stop_requested()) {
        static_cast<void>(watchdog_.check(clock_.now()));
      }
    }
  });
}

WatchdogThread::~WatchdogThread() {
  thread_.request_stop();
  thread_.join();
  watchdog_.disarm();
}

}  // namespace cellmirror
