#include "rt_core/kinematics/fast_step.hpp"

#include <algorithm>

#include "rt_core/kinematics/descent.hpp"
#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::kinematics {

FastResult fast_solve(const Chain& chain, const Task& task, const Pose& X_BG, std::span<double> q,
                      const FastOptions& options) CELL_RT {
  // So that rounding never puts a result on the wrong side of the tolerance.
  constexpr double kShareOfTolerance = 0.5;
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = std::clamp(q[i], chain.lower()[i], chain.upper()[i]);
  Descent descent(chain, task, X_BG);
  FastResult result;
  result.iterations =
      descent.meet(q, {.tolerance = kShareOfTolerance * options.tolerance, .max_iterations = options.max_iterations})
          .iterations;
  result.error = task_error(task, forward(chain, q), X_BG);
  result.solved = meets(task, result.error, options.tolerance);
  return result;
}

}  // namespace cellmirror::kinematics
