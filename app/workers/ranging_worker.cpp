#include "app/workers/ranging_worker.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace cellmirror::app {

RangingWorker::RangingWorker(engine::TickReader& ticks, const Board<CellState>& cell_states, const Clock& clock,
                             Nanoseconds tick_period, std::shared_ptr<geometry::SolidLibrary> solids,
                             std::vector<LightBarrier> barriers)
    : clock_(clock),
      has_barriers_(!barriers.empty()),
      finder_(std::move(solids), std::move(barriers)),
      worker_(*this, ticks, cell_states, clock, tick_period) {}

bool RangingWorker::wanted(const CellState& cell_state) {
  const bool wanted = has_barriers_ || std::ranges::any_of(cell_state.cell->sensors, [](const CompiledSensor& sensor) {
                        return sensor.sensor.active;
                      });
  if (!wanted) {
    ages_.paused();
    show_nothing();
  }
  return wanted;
}

// When the last sensor was switched off: readers remove what they draw.
void RangingWorker::show_nothing() {
  const auto last = board_.latest();
  if (!last || last->readings.empty()) return;
  std::shared_ptr<RangeReadings> nothing = recycled_.take();
  nothing->sequence = ++sequence_;
  nothing->posture_time = last->posture_time;
  nothing->finished = last->finished;
  nothing->readings.clear();
  board_.publish(std::move(nothing));
}

void RangingWorker::run(const CellState& cell_state, const engine::TickState& tick) {
  if (follower_.take_cell(cell_state.cell)) finder_.adopt(follower_.cell());
  if (!follower_.take_posture(tick)) return;
  const Timestamp start = clock_.now();
  const std::span<const RangeReading> found =
      finder_.read(follower_.poses(), tick.time, ranging::Selection::active_sensors);
  std::shared_ptr<RangeReadings> readings = recycled_.take();
  readings->sequence = ++sequence_;
  readings->posture_time = tick.time;
  const std::span<const BarrierReading> barriers = finder_.read_barriers(follower_.poses(), tick.time);
  readings->barriers.assign(barriers.begin(), barriers.end());
  readings->finished = clock_.now();
  readings->readings.assign(found.begin(), found.end());
  compute_.record(readings->finished - start);
  board_.publish(std::move(readings));
  ages_.shown(tick.time, clock_.now());
}

RangeReport RangingWorker::report() const {
  return {board_.latest(), worker_.skipped(), worker_.rate_hz(), ages_.age().snapshot(), compute_.snapshot()};
}

}  // namespace cellmirror::app
