#include "rt_core/kinematics/null_space.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "rt_core/kinematics/descent.hpp"
#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::kinematics {

namespace {

using Values = std::array<double, kMaxVariables>;

unsigned equations_of(const Task& task) CELL_RT {
  const auto positions = static_cast<unsigned>(std::popcount(static_cast<unsigned>(task.position_axes & 0b111U)));
  if (task.orientation == OrientationTask::free) return positions;
  return positions + (task.orientation == OrientationTask::full ? 3U : 2U);
}

// Where the secondary objective pulls each variable, without units.
Values pull_at(const Descent& descent, std::span<const double> present, std::span<const double> q) CELL_RT {
  const bool even = descent.task().secondary == Secondary::even_bend;
  Values pull{};
  for (std::size_t i = 0; i < q.size(); ++i) {
    double aim = present[i];
    if (even && !descent.chain().rotates(i)) aim = q[i];
    if (even && bends(descent.chain(), descent.task(), i)) aim = 0.0;
    pull[i] = descent.scaled(i, aim - q[i]);
  }
  return pull;
}

double squared(const Values& values) CELL_RT {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return sum;
}

// An orientation that is only attempted, and how far off it may be after a step.
struct Attempt {
  bool out_of_reach = false;
  double norm = 0;
};

Attempt attempt_at(const Task& task, const Pose& X_BT, const Pose& X_BG, double tolerance) CELL_RT {
  Attempt attempt;
  if (task.orientation_required || task.orientation == OrientationTask::free) return attempt;
  const Twist error = task_error(task, X_BT, X_BG);
  attempt.norm = error.tail<3>().norm();
  attempt.out_of_reach = error.tail<3>().cwiseAbs().maxCoeff() > tolerance;
  return attempt;
}

}  // namespace

bool has_choice(const Chain& chain, const Task& task) CELL_RT { return chain.variable_count() > equations_of(task); }

int settle(const Chain& chain, const Task& task, const Pose& X_BG, std::span<const double> present, std::span<double> q,
           const SettleOptions& options) CELL_RT {
  constexpr double kLongestPull = 1.0;  // rad, units of length: further, the linear picture says too little
  constexpr double kShortestStep = 3e-3;
  constexpr double kLeastGain = 1e-4;
  constexpr double kDamping = 1e-9;
  constexpr double kShareOfTolerance = 0.5;
  constexpr double kSlack = 1e-6;  // rad, of an attempted orientation
  const DescentOptions correction = {.tolerance = kShareOfTolerance * options.tolerance, .max_iterations = 4};
  Descent descent(chain, task, X_BG);
  const Attempt attempt = attempt_at(task, forward(chain, q), X_BG, options.tolerance);
  Linearised at;
  Values dq{};
  Values moved{};
  const std::span<double> candidate(moved.data(), q.size());
  double share = 1.0;
  int taken = 0;
  for (int step = 0; step < options.max_steps && share > 0.1; ++step) {
    Values pull = pull_at(descent, present, q);
    const double objective = squared(pull);
    const double shorten = share * std::min(1.0, kLongestPull / std::sqrt(std::max(objective, 1e-30)));
    for (double& component : pull) component *= shorten;
    descent.linearise(q, 1.0, at);
    if (attempt.out_of_reach) std::fill(at.e.begin() + 3, at.e.end(), 0.0);  // kept as it is
    if (box_step_towards(at, descent.room_at(q), kDamping, pull, dq) < kShortestStep) break;
    for (std::size_t i = 0; i < q.size(); ++i) {
      candidate[i] = std::clamp(q[i] + descent.unscaled(i, dq[i]), chain.lower()[i], chain.upper()[i]);
    }
    (void)descent.meet(candidate, correction);
    const Twist error = task_error(task, forward(chain, candidate), X_BG);
    const bool kept =
        meets(task, error, options.tolerance) &&
        (task.orientation_required ||
         error.tail<3>().norm() <= attempt.norm + kSlack + (attempt.out_of_reach ? 0.0 : options.tolerance));
    if (!kept || squared(pull_at(descent, present, candidate)) > (1.0 - kLeastGain) * objective) {
      share *= 0.4;
      continue;
    }
    std::copy(candidate.begin(), candidate.end(), q.begin());
    ++taken;
  }
  return taken;
}

}  // namespace cellmirror::kinematics
