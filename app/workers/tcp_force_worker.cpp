#include "app/workers/tcp_force_worker.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace cellmirror::app {

namespace {

// Returns the haptic device that moves the robot; null: none.
const HapticState* haptic_of(std::size_t slot, const engine::TickState& tick) {
  const auto state = std::ranges::find_if(tick.haptics, [&](const HapticState& haptic) {
    return haptic.phase != HapticPhase::closed && haptic.slot == slot;
  });
  return state == tick.haptics.end() ? nullptr : &*state;
}

void set_values(TcpForce& out, const Eigen::Vector3d& force, double axis_torque) {
  for (std::size_t i = 0; i < 3; ++i) out.values[i] = static_cast<float>(force[static_cast<Eigen::Index>(i)]);
  out.values[3] = static_cast<float>(axis_torque);
  out.flags = kTcpForceValid;
}

// Sets the force of the haptic device that moves the active robot, else that of the tissue that the robot touches.
// Without either, the force stays invalid.
void set_measured(TcpForce& out, const CellState& cell_state, const engine::TickState& tick,
                  const InstrumentLoads* loads) {
  const auto robot = std::ranges::find(cell_state.robots, cell_state.active_robot, &RobotSnapshot::id);
  if (robot == cell_state.robots.end()) return;
  if (const HapticState* haptic = haptic_of(robot->slot, tick)) {
    set_values(out, haptic->force_E, haptic->axis_torque);
  } else if (const InstrumentLoad* load = loads == nullptr ? nullptr : loads->find(robot->slot, tick.time)) {
    set_values(out, load->force_T, load->torque_T.z());
  }
}

bool is_beyond(const TcpForce& force, const ForceLimits& limits) {
  const double newton = std::hypot(force.values[0], force.values[1], force.values[2]);
  const double newton_metres = std::abs(static_cast<double>(force.values[3]));
  return (limits.max_force > 0 && newton > limits.max_force) ||
         (limits.max_torque > 0 && newton_metres > limits.max_torque);
}

}  // namespace

TcpForce tcp_force_of(const CellState& cell_state, const engine::TickState& tick, const InstrumentLoads* loads) {
  TcpForce out;
  out.time = tick.time;
  out.process = static_cast<std::uint32_t>(getpid());
  out.robot.assign(cell_state.active_robot);
  if (cell_state.forces.test) {
    std::ranges::transform(*cell_state.forces.test, out.values.begin(), [](double v) { return static_cast<float>(v); });
    out.flags = kTcpForceValid | kTcpForceTest;
  } else {
    set_measured(out, cell_state, tick, loads);
  }
  if (is_beyond(out, cell_state.forces.limits)) out.flags |= kTcpForceBeyondLimit;
  return out;
}

TcpForceWorker::TcpForceWorker(engine::TickReader& ticks, const Board<CellState>& cell_states, const Clock& clock,
                               Nanoseconds tick_period, const Board<InstrumentLoads>* loads)
    : loads_(loads), worker_(*this, ticks, cell_states, clock, tick_period) {}

void TcpForceWorker::run(const CellState& cell_state, const engine::TickState& tick) {
  const std::shared_ptr<const InstrumentLoads> loads = loads_ == nullptr ? nullptr : loads_->latest();
  TcpForce force = tcp_force_of(cell_state, tick, loads.get());
  force.sequence = ++sequence_;
  cell_state.tcp_force->write(force);
}

}  // namespace cellmirror::app
