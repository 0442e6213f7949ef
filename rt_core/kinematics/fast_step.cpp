#include "rt_core/kinematics/fast_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "rt_core/kinematics/damped_kernel.hpp"
#include "rt_core/kinematics/fast_search.hpp"
#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::kinematics {

namespace {

using kernel::Evaluation;
using kernel::Outcome;
using kernel::Stop;

// Of the tolerance, so that what the plain forward kinematics says of the result is never on the wrong side.
constexpr double kShareOfTolerance = 0.5;

Stop stop_for(const PackedChain& chain, const FastOptions& options, double weight) CELL_RT {
  Stop stop;
  stop.max_iterations = options.max_iterations;
  const double tolerance = kShareOfTolerance * options.tolerance;
  for (std::size_t k = 0; k < 3; ++k) stop.tolerance[k] = tolerance / chain.length;
  for (std::size_t k = 3; k < 6; ++k) stop.tolerance[k] = weight > 0 ? weight * tolerance : 1.0;
  return stop;
}

template <int N>
Outcome search_required(const PackedChain& chain, const PackedGoal& goal, const FastOptions& options,
                        double* q) CELL_RT {
  Evaluation<N> at;
  return kernel::descend<N>(chain, goal, 1.0, stop_for(chain, options, 1.0), q, at);
}

// Orientation as near as possible after the position: the weight of the orientation goes down in stages, so that each
// begins near its end, and the last stage meets what is required by the smallest correction.
template <int N>
Outcome search_attempted(const PackedChain& chain, const PackedGoal& goal, const FastOptions& options,
                         double* q) CELL_RT {
  constexpr std::array kWeights = {1.0, 0.1, 0.01, 0.0};
  constexpr double kStageEnds = 1e-4;  // a step below this (rad, units of length) ends a stage
  Outcome all;
  Evaluation<N> at;
  for (const double weight : kWeights) {
    Stop stop = stop_for(chain, options, weight);
    stop.max_iterations = std::max(options.max_iterations - all.iterations, weight > 0 ? 0 : 8);
    stop.smallest_step = weight > 0 ? kStageEnds : 0.0;
    const Outcome stage = kernel::descend<N>(chain, goal, weight, stop, q, at);
    all.iterations += stage.iterations;
    all.met = stage.met;
    if (stage.met && weight > 0) break;  // all of it, orientation included
  }
  return all;
}

template <int N>
Outcome search(const PackedChain& chain, const PackedGoal& goal, bool required, const FastOptions& options,
               double* q) CELL_RT {
  return required ? search_required<N>(chain, goal, options, q) : search_attempted<N>(chain, goal, options, q);
}

Outcome search_sized(const PackedChain& chain, const PackedGoal& goal, bool required, const FastOptions& options,
                     double* q) CELL_RT {
  if (!chain.plain) return search<0>(chain, goal, required, options, q);
  switch (chain.variables) {
    case 1:
      return search<1>(chain, goal, required, options, q);
    case 2:
      return search<2>(chain, goal, required, options, q);
    case 3:
      return search<3>(chain, goal, required, options, q);
    case 4:
      return search<4>(chain, goal, required, options, q);
    case 5:
      return search<5>(chain, goal, required, options, q);
    case 6:
      return search<6>(chain, goal, required, options, q);
    case 7:
      return search<7>(chain, goal, required, options, q);
    case 8:
      return search<8>(chain, goal, required, options, q);
    default:
      return search<0>(chain, goal, required, options, q);
  }
}

}  // namespace

FastResult FastSearch::solve(const Task& task, const Pose& X_BG, std::span<double> q,
                             const FastOptions& options) const CELL_RT {
  const PackedGoal goal(packed_, task, X_BG);
  const std::size_t n = chain_.variable_count();
  std::array<double, kMaxVariables> values{};
  for (std::size_t i = 0; i < n; ++i) {
    values[i] = std::clamp(q[i] * packed_.scale[i], packed_.lower[i], packed_.upper[i]);
  }
  const bool required = task.orientation_required || task.orientation == OrientationTask::free;
  const Outcome outcome = search_sized(packed_, goal, required, options, values.data());
  for (std::size_t i = 0; i < n; ++i) {
    q[i] = std::clamp(values[i] / packed_.scale[i], chain_.lower()[i], chain_.upper()[i]);
  }
  FastResult result;
  result.iterations = outcome.iterations;
  result.error = task_error(task, forward(chain_, q), X_BG);
  result.solved = meets(task, result.error, options.tolerance);
  return result;
}

FastResult fast_solve(const Chain& chain, const Task& task, const Pose& X_BG, std::span<double> q,
                      const FastOptions& options) CELL_RT {
  return FastSearch(chain).solve(task, X_BG, q, options);
}

}  // namespace cellmirror::kinematics
