#include "app/workers/trace_worker.hpp"

#include <algorithm>
#include <memory>

namespace cellmirror::app {

TraceWorker::TraceWorker(engine::TickReader& ticks, const Board<CellState>& cell_states, const Clock& clock,
                         Nanoseconds tick_period)
    : clock_(clock), worker_(*this, ticks, cell_states, clock, tick_period) {}

bool TraceWorker::wanted(const CellState& cell_state) {
  const bool on = cell_state.display && cell_state.display->on(DisplayMode::smear);
  // It may have been off between two calls.
  const std::uint64_t ends = cell_state.display ? cell_state.display->smear_ends : 0;
  if (ends == smear_ends_ && (on || recorder_.empty())) return on;
  smear_ends_ = ends;
  recorder_.clear();
  publish();
  return on;
}

void TraceWorker::run(const CellState& cell_state, const engine::TickState& tick) {
  const auto& robots = cell_state.cell->robots;
  const auto robot = std::ranges::find(robots, cell_state.active_robot, &CompiledRobot::id);
  if (robot != robots.end() && poser_.take(*cell_state.cell, tick))
    changed_ = recorder_.extend(robot->id, tcp_poses(*robot, poser_.poses()).X_WT) || changed_;
  if (changed_ && clock_.now() - published_ >= kPublishEvery) publish();
}

void TraceWorker::publish() {
  auto state = std::make_shared<TraceState>();
  state->smear_ends = smear_ends_;
  state->traces = recorder_.traces();
  board_.publish(std::move(state));
  changed_ = false;
  published_ = clock_.now();
}

}  // namespace cellmirror::app
