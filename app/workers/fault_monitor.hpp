// Watches the loop from outside: a loop that stands still or misses too many periods is a fault. A fault latches until
// the loop has been healthy for a while, and has the flight recorder written.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "app/snapshot/fault_status.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/rt/cyclic_thread.hpp"
#include "rt_core/rt/wake_signal.hpp"
#include "rt_core/rt/watchdog.hpp"

namespace cellmirror::app {

// When missed periods are a fault, and when flight records are written. No clock, no thread: for tests.
class OverloadRule {
 public:
  static constexpr std::uint64_t kMissedInWindow = 20;  // what Franka's controllers stop for, in one second at 1 kHz
  static constexpr Nanoseconds kWindow{1'000'000'000};

  // Told the number of periods missed since the start, several times a window. True where the window holds too many.
  bool check(Timestamp now, std::uint64_t missed);

 private:
  Timestamp window_start_;
  std::uint64_t missed_at_start_ = 0;
};

class FaultMonitor {
 public:
  static constexpr Nanoseconds kHealthyFor{10'000'000'000};   // then a latched fault is let go
  static constexpr Nanoseconds kRecordEvery{60'000'000'000};  // at most one file in that time
  static constexpr int kMaxRecords = 20;                      // a run

  // `write_record` writes the flight record and returns the file's path.
  FaultMonitor(const CyclicThread& loop, Watchdog& watchdog, const Clock& clock,
               std::function<Result<std::string>(const std::string& reason)> write_record);
  ~FaultMonitor();
  FaultMonitor(const FaultMonitor&) = delete;
  FaultMonitor& operator=(const FaultMonitor&) = delete;

  [[nodiscard]] FaultStatus status() const;  // any thread

 private:
  void watch(const std::stop_token& stop);
  void fault(Timestamp now, const std::string& reason);
  void let_go_when_healthy(Timestamp now);

  const CyclicThread& loop_;
  Watchdog& watchdog_;
  const Clock& clock_;
  std::function<Result<std::string>(const std::string& reason)> write_record_;
  OverloadRule overload_;
  Timestamp last_fault_;
  Timestamp last_record_;
  int records_ = 0;
  WakeSignal wake_;
  mutable std::mutex mutex_;
  FaultStatus status_;
  std::jthread thread_;  // last: it uses everything above
};

}  // namespace cellmirror::app
