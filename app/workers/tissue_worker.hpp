// Simulates the tissue of the cell in a thread of its own, a step each millisecond of real time shortly behind a tick
// (tick_phase.hpp), and hands the forces on instruments to the tick, which never waits for it.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "app/snapshot/board.hpp"
#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/object_pool.hpp"
#include "app/snapshot/tissue_port.hpp"
#include "app/snapshot/tissue_report.hpp"
#include "app/workers/tissue_stepper.hpp"
#include "rt_core/base/rate_meter.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/ports/instrument_load.hpp"
#include "rt_core/ports/tissue_state.hpp"
#include "rt_core/rt/latency_histogram.hpp"
#include "rt_core/rt/wake_signal.hpp"

namespace cellmirror::app {

class TissueWorker final : public TissuePort {
 public:
  static constexpr std::size_t kMostRequests = 256;  // that wait for a step

  // Nothing runs yet: commands wait. References outlive the worker.
  TissueWorker(tissue::World world, std::shared_ptr<geometry::SolidLibrary> solids, engine::Engine& engine,
               engine::TickReader& ticks, const Board<CellState>& cell_states, const Clock& clock);
  ~TissueWorker() override;
  TissueWorker(const TissueWorker&) = delete;
  TissueWorker& operator=(const TissueWorker&) = delete;

  // Makes the simulation of these objects, seconds for large ones; null where there are none.
  static Result<std::unique_ptr<TissueWorker>> make(const std::vector<tissue::ObjectDescription>& objects,
                                                    const std::vector<tissue::Connection>& connections,
                                                    std::shared_ptr<geometry::SolidLibrary> solids,
                                                    engine::Engine& engine, engine::TickReader& ticks,
                                                    const Board<CellState>& cell_states, const Clock& clock);

  // Under SCHED_FIFO at `priority` (at least 1), unless `policy` is off or the machine does not allow it: then as an
  // ordinary thread with short time slices.
  void start(RealTimePolicy policy = RealTimePolicy::off, int priority = 1);
  // No step any more; commands are still taken, without effect.
  void stop();

  Result<void> request(std::vector<tissue::Command> commands) override;
  // Any thread.
  [[nodiscard]] const Board<TissueReport>& reports() const { return reports_; }
  // The newest loads on all instruments, including those that no haptic device moves.
  [[nodiscard]] const Board<InstrumentLoads>& loads() const { return loads_; }
  // The newest shapes; they are made some thirty times a second for a while after each call, else not at all: the first
  // call after a while waits for one, for a tenth of a second at most. Null before the first step.
  [[nodiscard]] std::shared_ptr<const TissueView> view();

 private:
  void loop(const std::stop_token& stop);
  void take_requests();
  Nanoseconds step();
  void publish_forces(const engine::TickState& tick);
  void publish_loads(const engine::TickState& tick);
  void publish_report(Timestamp now);
  void publish_view(Timestamp now);

  engine::Engine& engine_;
  engine::TickReader& ticks_;
  const Board<CellState>& cell_states_;
  const Clock& clock_;
  TissueStepper stepper_;

  std::mutex mutex_;  // of requests_
  std::vector<tissue::Command> requests_;
  std::vector<tissue::Command> taken_;

  std::shared_ptr<const CellState> cell_state_;
  std::uint64_t sequence_ = 0;
  std::uint64_t steps_ = 0;
  std::uint64_t late_steps_ = 0;
  CounterRate rate_{Nanoseconds(1'000'000'000)};
  LatencyHistogram compute_;
  LatencyHistogram pose_to_force_;
  Timestamp reported_;
  Timestamp viewed_;
  Board<TissueReport> reports_;
  ObjectPool<InstrumentLoads> load_pool_;
  Board<InstrumentLoads> loads_;
  Board<TissueView> views_;
  std::atomic<std::int64_t> view_wanted_ns_{0};  // when it was asked for last
  std::mutex view_mutex_;                        // of view_time_ns_
  std::condition_variable view_came_;
  std::int64_t view_time_ns_ = 0;  // of the newest view
  WakeSignal wake_;
  std::jthread thread_;  // last: it uses everything above
};

}  // namespace cellmirror::app
