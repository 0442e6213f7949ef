// A thread that does a job once a tick, or as often as the job's length allows, always with the newest tick; ticks that
// are passed over are counted. The tick never waits for it.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "app/snapshot/cell_state.hpp"
#include "rt_core/base/rate_meter.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/engine/tick_reader.hpp"
#include "rt_core/rt/wake_signal.hpp"

namespace cellmirror::app {

// Called by the worker's thread only.
class TickJob {
 public:
  virtual ~TickJob() = default;
  // Whether there is anything to do; where not, the worker sleeps and asks again after TickWorker::kIdle.
  virtual bool wanted(const CellState& cell_state) = 0;
  virtual void run(const CellState& cell_state, const engine::TickState& tick) = 0;
};

class TickWorker {
 public:
  static constexpr Nanoseconds kIdle{20'000'000};

  // All are not owned and outlive the worker. Its thread has the name of the reader.
  TickWorker(TickJob& job, engine::TickReader& ticks, const Board<CellState>& board, const Clock& clock,
             Nanoseconds tick_period);
  // Waits for the end of the job under way.
  ~TickWorker();
  TickWorker(const TickWorker&) = delete;
  TickWorker& operator=(const TickWorker&) = delete;

  // Any thread.
  // How often the job ran in the last second; 0 while there is nothing to do.
  [[nodiscard]] double rate_hz() const { return 1e-3 * static_cast<double>(rate_mhz_.load(std::memory_order_relaxed)); }
  // Ticks that passed while the job was busy with an older one.
  [[nodiscard]] std::uint64_t skipped() const { return skipped_.load(std::memory_order_relaxed); }

 private:
  void loop(const std::stop_token& stop);
  // Until the tick after `tick` has published its state, as far as its phase tells; short where it is late.
  void wait_for_tick(const engine::TickState& tick, int tries);
  void count_run();
  void rest();

  TickJob& job_;
  engine::TickReader& ticks_;
  const Board<CellState>& board_;
  const Clock& clock_;
  Nanoseconds tick_period_;
  WakeSignal wake_;
  CounterRate rate_{Nanoseconds(1'000'000'000)};
  std::uint64_t runs_ = 0;
  std::atomic<std::uint64_t> rate_mhz_{0};  // millihertz
  std::atomic<std::uint64_t> skipped_{0};
  std::jthread thread_;  // last: it uses everything above
};

}  // namespace cellmirror::app
