#include "app/workers/fault_monitor.hpp"

#include <fmt/format.h>

#include <utility>

#include "rt_core/base/log.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::app {

namespace {

constexpr std::chrono::milliseconds kCheckEvery{25};

}  // namespace

bool OverloadRule::check(Timestamp now, std::uint64_t missed) {
  if (!window_start_.known()) {
    window_start_ = now;
    missed_at_start_ = missed;
    return false;
  }
  const bool too_many = missed - missed_at_start_ >= kMissedInWindow;
  if (too_many || now - window_start_ >= kWindow) {
    window_start_ = now;
    missed_at_start_ = missed;
  }
  return too_many;
}

FaultMonitor::FaultMonitor(const CyclicThread& loop, Watchdog& watchdog, const Clock& clock,
                           std::function<Result<std::string>(const std::string& reason)> write_record)
    : loop_(loop),
      watchdog_(watchdog),
      clock_(clock),
      write_record_(std::move(write_record)),
      thread_([this](const std::stop_token& stop) { watch(stop); }) {}

FaultMonitor::~FaultMonitor() {
  thread_.request_stop();
  wake_.wake();
  thread_.join();
}

FaultStatus FaultMonitor::status() const {
  const std::scoped_lock lock(mutex_);
  return status_;
}

void FaultMonitor::watch(const std::stop_token& stop) {
  set_thread_name("fault-monitor");
  watchdog_.arm(clock_.now());
  bool was_silent = false;
  while (!stop.stop_requested()) {
    wake_.wait(kCheckEvery);
    const Timestamp now = clock_.now();
    const bool silent = !watchdog_.check(now);
    if (silent && !was_silent) fault(now, "the loop stood still");
    was_silent = silent;
    if (overload_.check(now, loop_.missed()))
      fault(now, fmt::format("{} periods missed within a second", OverloadRule::kMissedInWindow));
    let_go_when_healthy(now);
    if (was_silent && !watchdog_.faulted()) was_silent = false;
  }
  watchdog_.disarm();
}

void FaultMonitor::fault(Timestamp now, const std::string& reason) {
  last_fault_ = now;
  // A latched fault is reported once; it stays latched for as long as the loop is not healthy.
  if (status().latched) return;
  {
    // Before the record is written, which takes time.
    const std::scoped_lock lock(mutex_);
    status_.latched = true;
    status_.reason = reason;
  }
  std::string told = reason;
  const bool record_due = records_ < kMaxRecords && (!last_record_.known() || now - last_record_ > kRecordEvery);
  if (record_due) {
    last_record_ = now;
    ++records_;
    const Result<std::string> written = write_record_(reason);
    told += written ? "; flight record: " + *written : "; no flight record: " + written.error().text();
  }
  log_error("loop.fault", "{}", told);
  const std::scoped_lock lock(mutex_);
  ++status_.faults;
  // A fault without a record of its own must not hide where the record is.
  if (record_due || status_.last.empty()) status_.last = told;
}

void FaultMonitor::let_go_when_healthy(Timestamp now) {
  if (!last_fault_.known() || now - last_fault_ < kHealthyFor) return;
  last_fault_ = Timestamp{};
  watchdog_.reset(now);
  const std::scoped_lock lock(mutex_);
  status_.latched = false;
}

}  // namespace cellmirror::app
