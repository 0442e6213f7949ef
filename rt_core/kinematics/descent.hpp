// Search downhill from a posture: what fast_solve() and the null-space search are made of. Internal to the folder.
#pragma once

#include <array>
#include <span>

#include "rt_core/kinematics/box_step.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/kinematics/forward.hpp"
#include "rt_core/kinematics/task.hpp"

namespace cellmirror::kinematics {

struct DescentOptions {
  double tolerance = 1e-5;  // m, rad
  int max_iterations = 20;
  double smallest_step = 0;  // a shorter step (rad, units of length) ends the descent; 0: what gains nothing
};

struct DescentResult {
  bool met = false;
  int iterations = 0;
};

class Descent {
 public:
  // All three have to outlive it.
  Descent(const Chain& chain, const Task& task, const Pose& X_BG) CELL_RT;

  // From q (within the limits) to the posture of the least error that the steps reach, which is left in q. The
  // orientation counts with `orientation_weight`.
  DescentResult run(std::span<double> q, double orientation_weight, const DescentOptions& options) CELL_RT;

  // The same for the task as it is: an orientation that is only attempted comes as near as possible once the position
  // is met.
  DescentResult meet(std::span<double> q, const DescentOptions& options) CELL_RT;

  // The error and its derivative at q.
  void linearise(std::span<const double> q, double orientation_weight, Linearised& at) CELL_RT;
  [[nodiscard]] Room room_at(std::span<const double> q) const CELL_RT;
  // A step in units of the linearised problem in rad or m.
  [[nodiscard]] double unscaled(std::size_t variable, double step) const CELL_RT {
    return chain_.rotates(variable) ? step : step * length_;
  }
  [[nodiscard]] double scaled(std::size_t variable, double value) const CELL_RT {
    return chain_.rotates(variable) ? value : value / length_;
  }
  [[nodiscard]] const Chain& chain() const CELL_RT { return chain_; }
  [[nodiscard]] const Task& task() const CELL_RT { return task_; }

 private:
  DescentResult meet_in_stages(std::span<double> q, const DescentOptions& options) CELL_RT;
  void orient(const Pose& X_BT, double weight, Linearised& at) const CELL_RT;
  [[nodiscard]] bool within(const Six& e, double orientation_weight, double tolerance) const CELL_RT;

  const Chain& chain_;
  const Task& task_;
  const Pose& X_BG_;
  double length_;
  Jacobian jacobian_;
};

}  // namespace cellmirror::kinematics
