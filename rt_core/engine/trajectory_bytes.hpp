// Trajectories as bytes, and back from any bytes. Not for the tick.
#pragma once

#include <cstddef>
#include <optional>

#include "rt_core/base/state_bytes.hpp"
#include "rt_core/motion/trajectory.hpp"

namespace cellmirror::engine {

// At least what write_trajectory() needs.
[[nodiscard]] std::size_t bytes_of(const motion::Trajectory& trajectory);
void write_trajectory(StateWriter& out, const motion::Trajectory& trajectory);
// None, and `in` fails, where the tick would not take it.
[[nodiscard]] std::optional<motion::Trajectory> read_trajectory(StateReader& in);

}  // namespace cellmirror::engine
