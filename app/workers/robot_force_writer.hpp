// Gives the forces of the newest tick to the plain buffers of rob_ela_shm.
#pragma once

#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/force_report.hpp"
#include "rt_core/engine/engine.hpp"

namespace cellmirror::app {

// To each buffer of `cell_state`: of a robot that a haptic device moves, force and joint torques of the device's
// contacts, as its own memory has them; else the computed force at the TCP and the efforts of the drives; zeros where
// neither is known. `forces` is computed from `tick`.
void write_robot_forces(const CellState& cell_state, const engine::TickState& tick, const ForceState& forces);

}  // namespace cellmirror::app
