// Notices from outside that the tick has stopped ticking.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

struct WatchdogFault {
  Timestamp noticed;        // when the check failed
  Nanoseconds silence{0};   // for how long no beat had been seen by then
  std::uint64_t beats = 0;  // beats seen until then
};

// The logic: a counter that the watched thread moves, and checks by another thread. No clock and no thread of its own.
// A fault latches: it stays until reset(), whether or not the beats come back.
class Watchdog {
 public:
  // `timeout`: longer silence is a fault. `on_fault` (may be empty) is called once a fault by the thread that checks.
  Watchdog(Nanoseconds timeout, std::function<void(const WatchdogFault&)> on_fault);

  // The watched thread: once a cycle.
  void beat() CELL_RT {
    // Relaxed: the checker needs to know only that the counter moves. One writer: a plain load
    // and store saves the locked instruction.
    beats_.store(beats_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }

  // The checking thread, several times a timeout. True while all is well or nothing is watched. If the checks
  // themselves came late by more than half a timeout (the whole machine stood still), the silence is counted from
  // here again: it says nothing about the watched thread.
  bool check(Timestamp now);

  // Any thread but the tick. Watching begins with arm() (silence counts from then) and ends with disarm().
  void arm(Timestamp now);
  void disarm();
  // Clears a latched fault; the silence counts from `now`.
  void reset(Timestamp now);
  [[nodiscard]] std::optional<WatchdogFault> fault() const;
  // Any thread, the tick too.
  [[nodiscard]] bool faulted() const CELL_RT { return faulted_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t beats() const CELL_RT { return beats_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t faults() const CELL_RT { return faults_.load(std::memory_order_relaxed); }  // ever
  [[nodiscard]] Nanoseconds timeout() const { return timeout_; }

 private:
  const Nanoseconds timeout_;
  const std::function<void(const WatchdogFault&)> on_fault_;
  alignas(64) std::atomic<std::uint64_t> beats_{0};
  alignas(64) std::atomic<bool> faulted_{false};
  std::atomic<std::uint64_t> faults_{0};
  mutable std::mutex mutex_;  // of the members below; the watched thread never takes it
  bool armed_ = false;
  std::uint64_t seen_beats_ = 0;
  Timestamp last_change_;
  Timestamp last_check_;
  std::optional<WatchdogFault> fault_;
};

// A thread that checks a watchdog four times a timeout, as long as it lives.
class WatchdogThread {
 public:
  // Both outlive the thread. Arms the watchdog; the destructor disarms it.
  WatchdogThread(Watchdog& watchdog, const Clock& clock);
  ~WatchdogThread();
  WatchdogThread(const WatchdogThread&) = delete;
  WatchdogThread& operator=(const WatchdogThread&) = delete;

 private:
  Watchdog& watchdog_;
  const Clock& clock_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread thread_;
};

}  // namespace cellmirror
