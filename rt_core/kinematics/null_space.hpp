// Which of the postures that meet a task equally well: the secondary objective of redundant arms.
#pragma once

#include <span>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/kinematics/task.hpp"

namespace cellmirror::kinematics {

struct SettleOptions {
  double tolerance = 1e-5;  // m, rad: what the task is kept to
  int max_steps = 10;       // each costs about three iterations of fast_solve()
};

// More joints than equations, so that there is a choice.
[[nodiscard]] bool has_choice(const Chain& chain, const Task& task) CELL_RT;

// Moves q, which meets the task, along the postures that meet it downhill in the task's secondary objective:
// nearest_present: the sum of squared differences from `present`; even_bend: the sum of squared values of the turning
// joints. A sliding joint's metres count in units of unit_of_length(). q stays within the limits and meets the task
// throughout; an attempted orientation stays as near as it is. Returns the number of steps taken. No heap.
int settle(const Chain& chain, const Task& task, const Pose& X_BG, std::span<const double> present, std::span<double> q,
           const SettleOptions& options) CELL_RT;

}  // namespace cellmirror::kinematics
