#include "app/workers/force_worker.hpp"

#include <utility>

#include "app/workers/robot_force_writer.hpp"
#include "app/workers/robot_motions.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::app {

ForceWorker::ForceWorker(engine::TickReader& ticks, const Board<CellState>& cell_states, const Clock& clock,
                         Nanoseconds tick_period, const Eigen::Vector3d& gravity_W, const Board<InstrumentLoads>* loads)
    : clock_(clock),
      gravity_W_(gravity_W),
      loads_(loads),
      computation_(gravity_W),
      worker_(*this, ticks, cell_states, clock, tick_period) {}

void ForceWorker::take_cell(const CellState& cell_state) {
  if (!computation_.take_cell(cell_state.cell)) return;
  for (const dynamics::NotComputed& robot : computation_.not_computed())
    log_warning("forces.robot", "the forces of {} are not computed: {}", robot.robot, robot.why);
  const std::scoped_lock lock(mutex_);
  not_computed_ = computation_.not_computed();
}

bool ForceWorker::wanted(const CellState& cell_state) {
  take_cell(cell_state);
  const bool wanted = computation_.has_mechanisms() || !cell_state.haptics.empty() ||
                      !cell_state.robot_forces.empty() || loads_ != nullptr;
  if (!wanted) {
    ages_.paused();
    show_nothing();
  }
  const std::scoped_lock lock(mutex_);
  active_ = wanted;
  return wanted;
}

// After the last robot with masses was deleted, readers remove its efforts and arrows.
void ForceWorker::show_nothing() {
  const auto last = board_.latest();
  if (!last || last->robots.empty()) return;
  std::shared_ptr<ForceState> nothing = states_.take();
  nothing->sequence = ++sequence_;
  nothing->posture_time = last->posture_time;
  nothing->robots.clear();
  board_.publish(std::move(nothing));
}

void ForceWorker::run(const CellState& cell_state, const engine::TickState& tick) {
  take_cell(cell_state);
  if (!read_motions(*cell_state.cell, tick, motions_)) return;
  const Timestamp start = clock_.now();
  std::shared_ptr<ForceState> state = states_.take();
  const std::shared_ptr<const InstrumentLoads> loads = loads_ == nullptr ? nullptr : loads_->latest();
  computation_.compute(tick.time, motions_, tick.haptics, loads.get(), *state);
  compute_.record(clock_.now() - start);
  write_robot_forces(cell_state, tick, *state);
  state->sequence = ++sequence_;
  board_.publish(std::move(state));
  ages_.shown(tick.time, clock_.now());
  const std::scoped_lock lock(mutex_);
  limit_warnings_ = computation_.limit_warnings();
}

ForceReport ForceWorker::report() const {
  ForceReport report;
  report.gravity_m_s2 = gravity_W_;
  report.state = board_.latest();
  report.skipped = worker_.skipped();
  report.rate_hz = worker_.rate_hz();
  report.visible_after = ages_.visible_after().snapshot();
  report.compute = compute_.snapshot();
  const std::scoped_lock lock(mutex_);
  report.active = active_;
  report.not_computed = not_computed_;
  report.limit_warnings = limit_warnings_;
  return report;
}

}  // namespace cellmirror::app
