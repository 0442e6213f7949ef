// One bounded step of inverse kinematics: what the tick uses to follow a path, and what the searches are made of.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/kinematics/task.hpp"

namespace cellmirror::kinematics {

struct FastOptions {
  double tolerance = 1e-5;  // of each required component: m, rad
  int max_iterations = 20;  // bounds the time; a tick that follows a path needs 1 or 2
};

struct FastResult {
  bool solved = false;
  int iterations = 0;
  Twist error = Twist::Zero();  // task_error() at the values that were left in q
};

// Damped least squares (Levenberg-Marquardt) inside the box of the joint limits, from q to a posture that meets the
// task; q is left at the best posture found, always within the limits. Deterministic; no heap. A task that is only
// attempted in its orientation is met when its required components are. Nocedal, Wright, Numerical Optimization, 10.3;
// active set as in Bertsekas' projected Newton method.
FastResult fast_solve(const Chain& chain, const Task& task, const Pose& X_BG, std::span<double> q,
                      const FastOptions& options) CELL_RT;

}  // namespace cellmirror::kinematics
