// The owner of a cell in its thread beside a tick that does not run ahead of it: each tick comes a period of the cell's
// time after the one before, and not before the owner has seen that. However busy the machine is, the cell's time tells
// nothing of it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "tests/integration/simulate/real_time_owner.hpp"

namespace cellmirror::app {

// Set by one thread, read by any.
class SteppedClock final : public Clock {
 public:
  [[nodiscard]] Timestamp now() const CELL_RT override { return Timestamp{now_ns_.load(std::memory_order_acquire)}; }
  void advance(Nanoseconds by) { now_ns_.fetch_add(by.count(), std::memory_order_acq_rel); }

 private:
  std::atomic<std::int64_t> now_ns_{1'000'000'000};
};

class SteppedOwner {
 public:
  SteppedOwner(LoadedCell loaded, const Reply& /*it takes no commands*/, ProgramEvents event)
      : owner_(owner_parts(std::move(loaded), *engine_, board_, clock_, std::move(event))) {}

  // `script`: a path.
  void start(const std::string& script) {
    EXPECT_TRUE(owner_.prepare(script, true));
    owner_.start();
    tick_ = std::jthread([this](const std::stop_token& stop) { run_ticks(stop); });
  }
  void stop() {
    tick_ = {};
    owner_.stop();
  }

 private:
  void run_ticks(const std::stop_token& stop) {
    constexpr Nanoseconds kPeriod{1'000'000};
    CycleContext context;
    context.period = kPeriod;
    while (!stop.stop_requested()) {
      clock_.advance(kPeriod);
      context.now = clock_.now();
      context.scheduled = context.now;
      engine_->run(context);
      ++context.cycle;
      const std::uint64_t begun = owner_.turns();  // the newest may have looked before this tick
      while (owner_.turns() < begun + 2 && !stop.stop_requested()) {
        owner_.wake();
        std::this_thread::sleep_for(std::chrono::microseconds(20));
      }
    }
  }

  SteppedClock clock_;
  Watchdog watchdog_{std::chrono::milliseconds(100), {}};
  std::unique_ptr<engine::Engine> engine_ = std::make_unique<engine::Engine>(watchdog_);
  Board<CellState> board_;
  CellOwner owner_;
  std::jthread tick_;  // ends before what it uses
};

}  // namespace cellmirror::app
