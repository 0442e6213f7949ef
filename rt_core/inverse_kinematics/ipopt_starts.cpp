#include "rt_core/inverse_kinematics/ipopt_starts.hpp"

#include <limits>

namespace cellmirror::inverse_kinematics {

JointValues promising_start(const PostureSpread& spread, std::size_t round, PoseModel& model, const Problem& problem) {
  constexpr std::size_t kPosturesLookedAt = 200;
  const double weight = position_weight(model.chain());
  JointValues best{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t look = 0; look < kPosturesLookedAt; ++look) {
    const JointValues q = spread.at(round * kPosturesLookedAt + look);
    model.place({q.data(), model.chain().variable_count()});
    const double error = squared_task_error(problem.task, model.X_BT(), problem.X_BG, weight).value;
    if (error >= least) continue;
    least = error;
    best = q;
  }
  return best;
}

}  // namespace cellmirror::inverse_kinematics
