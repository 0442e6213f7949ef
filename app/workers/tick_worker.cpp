#include "app/workers/tick_worker.hpp"

#include <algorithm>

#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::app {

namespace {

// So long after a tick woke, its state is usually published.
constexpr Nanoseconds kBehindTick{60'000};
constexpr int kMostDoublings = 4;

}  // namespace

TickWorker::TickWorker(TickJob& job, engine::TickReader& ticks, const Board<CellState>& board, const Clock& clock,
                       Nanoseconds tick_period)
    : job_(job),
      ticks_(ticks),
      board_(board),
      clock_(clock),
      tick_period_(tick_period),
      thread_([this](const std::stop_token& stop) { loop(stop); }) {}

TickWorker::~TickWorker() {
  thread_.request_stop();
  wake_.wake();
  thread_.join();
}

void TickWorker::wait_for_tick(const engine::TickState& tick, int tries) {
  const Timestamp now = clock_.now();
  const Nanoseconds again = kBehindTick * (1 << std::min(tries, kMostDoublings));
  const Timestamp next = tick.time.known() ? tick.time + tick_period_ + kBehindTick : now;
  wake_.wait(std::clamp(next - now, again, kIdle));
}

void TickWorker::count_run() {
  rate_mhz_.store(static_cast<std::uint64_t>(1e3 * rate_.read(clock_.now(), ++runs_)), std::memory_order_relaxed);
}

void TickWorker::rest() {
  rate_.restart();
  rate_mhz_.store(0, std::memory_order_relaxed);
  wake_.wait(kIdle);
}

void TickWorker::loop(const std::stop_token& stop) {
  set_thread_name(ticks_.name());
  std::uint64_t done = 0;
  bool first = true;
  int tries = 0;
  while (!stop.stop_requested()) {
    const std::shared_ptr<const CellState> cell_state = board_.latest();
    const bool wanted = cell_state && job_.wanted(*cell_state);
    if (!wanted) {
      first = true;
      rest();
      continue;
    }
    const engine::TickState& tick = ticks_.newest();
    if (!tick.time.known() || (!first && tick.tick == done)) {
      wait_for_tick(tick, tries++);
      continue;
    }
    if (!first && tick.tick > done) skipped_.fetch_add(tick.tick - done - 1, std::memory_order_relaxed);
    job_.run(*cell_state, tick);
    count_run();
    done = tick.tick;
    first = false;
    tries = 0;
  }
}

}  // namespace cellmirror::app
