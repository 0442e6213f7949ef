#include "rt_core/kinematics/fast_step.hpp"

#include <algorithm>
#include <array>

#include "rt_core/kinematics/descent.hpp"
#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::kinematics {

namespace {

// Of the tolerance, so that rounding never puts a result on the wrong side of it.
constexpr double kShareOfTolerance = 0.5;

// Orientation as near as possible after the position: its weight goes down in stages, so that each begins near its end,
// and the last stage meets what is required by the smallest correction.
DescentResult run_attempted(Descent& descent, std::span<double> q, const FastOptions& options) CELL_RT {
  constexpr std::array kWeights = {1.0, 0.1, 0.01, 0.0};
  constexpr double kStageEnds = 1e-4;  // rad, units of length
  constexpr int kCorrections = 8;
  DescentResult all;
  for (const double weight : kWeights) {
    const bool last = weight == 0;
    const DescentOptions stage_options = {
        .tolerance = kShareOfTolerance * options.tolerance,
        .max_iterations = last ? kCorrections : std::max(options.max_iterations - all.iterations, 0),
        .smallest_step = last ? 0.0 : kStageEnds};
    const DescentResult stage = descent.run(q, weight, stage_options);
    all.iterations += stage.iterations;
    if (stage.met) break;
  }
  return all;
}

}  // namespace

FastResult fast_solve(const Chain& chain, const Task& task, const Pose& X_BG, std::span<double> q,
                      const FastOptions& options) CELL_RT {
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = std::clamp(q[i], chain.lower()[i], chain.upper()[i]);
  Descent descent(chain, task, X_BG);
  const bool attempted = !task.orientation_required && task.orientation != OrientationTask::free;
  const DescentResult descended =
      attempted
          ? run_attempted(descent, q, options)
          : descent.run(q, 1.0,
                        {.tolerance = kShareOfTolerance * options.tolerance, .max_iterations = options.max_iterations});
  FastResult result;
  result.iterations = descended.iterations;
  result.error = task_error(task, forward(chain, q), X_BG);
  result.solved = meets(task, result.error, options.tolerance);
  return result;
}

}  // namespace cellmirror::kinematics
