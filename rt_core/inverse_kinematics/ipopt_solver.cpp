#include "rt_core/inverse_kinematics/ipopt_solver.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

#include "rt_core/inverse_kinematics/ipopt_program.hpp"
#include "rt_core/inverse_kinematics/ipopt_starts.hpp"
#include "rt_core/inverse_kinematics/posture.hpp"
#include "rt_core/inverse_kinematics/request.hpp"
#include "rt_core/inverse_kinematics/search.hpp"
#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::inverse_kinematics {

namespace {

constexpr std::size_t kMostIpoptStarts = 200;  // bounds a search whose time limit does not
constexpr std::size_t kBarrenStarts = 25;      // without a new solution: there will be no more
constexpr double kNearTarget = 1.0;            // squared task error below which the equations can be met from here
constexpr int kNearIterations = 12;            // for that
// Kept back for the nearest pose, if there is no solution: this much, or this part of the time if that is less.
constexpr Nanoseconds kLastRun = std::chrono::milliseconds(2);
constexpr double kLastRunShare = 0.2;

bool only_attempts_orientation(const kinematics::Task& task) {
  return task.orientation != kinematics::OrientationTask::free && !task.orientation_required;
}

// What belongs to one request.
struct Work {
  Work(const kinematics::Chain& chain, const Request& request, const Clock& clock) : search(chain, request, clock) {}

  Search search;
  Problem problem;
  Timestamp deadline;
  Run nearest;           // of the descents that met nothing
  bool settled = false;  // the last descent has minimised the secondary objective as well
  bool timed_out = false;
  int iterations = 0;
};

class IpoptSolver final : public Solver {
 public:
  IpoptSolver(const kinematics::Chain& chain, const Clock& clock, const IpoptSettings& settings)
      : clock_(clock),
        model_(chain),
        spread_(chain),
        reach_(chain, Objective::squared_error, settings),
        refine_(chain, Objective::secondary, settings),
        align_(chain, Objective::orientation, settings) {
    for (std::size_t i = 0; i < chain.variable_count(); ++i) {
      if (chain.lower()[i] < chain.upper()[i]) ++free_variables_;
    }
  }

  [[nodiscard]] Result<Answer> solve(const Request& asked) override;

 private:
  [[nodiscard]] const kinematics::Chain& chain() const { return model_.chain(); }
  [[nodiscard]] static Run run(Work& work, IpoptProgram& program, const Problem& problem);
  void search(Work& work, std::size_t max_solutions);
  [[nodiscard]] Run descend(Work& work, bool from_present);
  [[nodiscard]] Run improve(Work& work, const Run& found);
  void give_nearest(Work& work);
  void miss(Work& work, const JointValues& q) const;
  [[nodiscard]] bool has_freedom(const Problem& problem);
  [[nodiscard]] bool near_target(const Problem& problem);

  const Clock& clock_;
  PoseModel model_;
  PostureSpread spread_;
  IpoptProgram reach_;
  IpoptProgram refine_;
  IpoptProgram align_;
  int free_variables_ = 0;
};

Result<Answer> IpoptSolver::solve(const Request& asked) {
  const Timestamp start = clock_.now();
  const Result<Request> good = checked(asked, chain());
  if (!good) return std::unexpected(good.error());
  const Request& request = *good;
  Work work(chain(), request, clock_);
  work.deadline = start + request.time_limit;
  Problem& problem = work.problem;
  problem.X_BG = request.X_BG;
  problem.task = request.task;
  problem.wished = work.search.wished();
  problem.start = request.present;
  problem.tolerance = request.tolerance;
  const auto share = std::chrono::duration_cast<Nanoseconds>(request.time_limit * kLastRunShare);
  problem.clock = &clock_;
  problem.deadline = work.deadline - std::min(kLastRun, share);
  work.nearest.q = request.present;
  work.nearest.cost = std::numeric_limits<double>::infinity();
  if (free_variables_ == 0) {
    if (!work.search.keep(request.present, FoundBy::ipopt)) miss(work, request.present);
  } else {
    search(work, request.max_solutions);
    if (work.search.found() == 0) give_nearest(work);
  }
  Answer answer = work.search.finish();
  answer.iterations += work.iterations;
  answer.timed_out = work.timed_out;
  return answer;
}

Run IpoptSolver::run(Work& work, IpoptProgram& program, const Problem& problem) {
  const Run result = program.run(problem);
  work.iterations += result.iterations;
  return result;
}

void IpoptSolver::search(Work& work, std::size_t max_solutions) {
  std::size_t barren = 0;
  for (std::size_t start = 0; start < kMostIpoptStarts && barren < kBarrenStarts; ++start) {
    if (start > 0) work.problem.start = promising_start(spread_, start - 1, model_, work.problem);
    const std::size_t known = work.search.found();
    const Run found = descend(work, start == 0);
    if (!found.met) {
      if (found.cost < work.nearest.cost) work.nearest = found;
    } else if (known > 0 && !only_attempts_orientation(work.problem.task)) {
      // Of a redundant arm's postures the first is the best that can be; improved, the others would be the same.
      (void)work.search.keep(found.q, FoundBy::ipopt);
    } else if (!work.search.keep(improve(work, found).q, FoundBy::ipopt)) {
      (void)work.search.keep(found.q, FoundBy::ipopt);
    }
    if (work.search.found() >= max_solutions) return;
    barren = work.search.found() > 0 && work.search.found() == known ? barren + 1 : 0;
    if (clock_.now() < work.problem.deadline) continue;
    work.timed_out = true;
    return;
  }
}

// From work.problem.start to a posture that meets the task. With freedom left and the target near, both at once:
// meeting it and the secondary objective.
Run IpoptSolver::descend(Work& work, bool from_present) {
  const Problem& problem = work.problem;
  work.settled = false;
  if (from_present && !only_attempts_orientation(problem.task) && near_target(problem) && has_freedom(problem)) {
    Problem both = problem;
    both.max_iterations = kNearIterations;
    const Run result = run(work, refine_, both);
    work.settled = result.met;
    if (result.met) return result;
  }
  return run(work, reach_, problem);
}

// Uses the freedom that is left at a posture that meets the task: first for an orientation that is only attempted, then
// for the secondary objective.
Run IpoptSolver::improve(Work& work, const Run& found) {
  if (work.settled) return found;
  Run best = found;
  Problem problem = work.problem;
  problem.deadline = work.deadline;
  problem.start = nearest_turns(chain(), best.q, problem.wished);
  if (clock_.now() >= problem.deadline || !has_freedom(problem)) return best;
  if (only_attempts_orientation(problem.task)) {
    const Run aligned = run(work, align_, problem);
    if (aligned.met) best = aligned;
    problem.start = best.q;
    problem.task.orientation_required = true;
    model_.place({best.q.data(), chain().variable_count()});
    const kinematics::Twist error = kinematics::task_error(problem.task, model_.X_BT(), problem.X_BG);
    if (!kinematics::meets(problem.task, error, problem.tolerance)) return best;  // it took all the freedom
    if (!has_freedom(problem)) return best;
  }
  const Run refined = run(work, refine_, problem);
  return refined.met ? refined : best;
}

bool IpoptSolver::has_freedom(const Problem& problem) {
  model_.place({problem.start.data(), chain().variable_count()});
  TaskEquations equations(problem.task, problem.X_BG);
  equations.keep_independent(model_);
  return equations.count() < free_variables_;
}

bool IpoptSolver::near_target(const Problem& problem) {
  model_.place({problem.start.data(), chain().variable_count()});
  const double weight = position_weight(chain());
  return squared_task_error(problem.task, model_.X_BT(), problem.X_BG, weight).value < kNearTarget;
}

// The descents that found nothing were given up on the way to their local minima; the best of them is finished.
void IpoptSolver::give_nearest(Work& work) {
  Problem problem = work.problem;
  problem.start = work.nearest.q;
  problem.deadline = work.deadline;
  problem.to_the_end = true;
  const Run end = run(work, reach_, problem);
  if (end.met && work.search.keep(end.q, FoundBy::ipopt)) return;
  miss(work, work.nearest.q);
  miss(work, end.q);
}

void IpoptSolver::miss(Work& work, const JointValues& q) const {
  const Pose X_BT = kinematics::forward(chain(), {q.data(), chain().variable_count()});
  work.search.miss(q, kinematics::task_error(work.problem.task, X_BT, work.problem.X_BG));
}

}  // namespace

std::unique_ptr<Solver> make_ipopt_solver(const kinematics::Chain& chain, const Clock& clock,
                                          const IpoptSettings& settings) {
  return std::make_unique<IpoptSolver>(chain, clock, settings);
}

}  // namespace cellmirror::inverse_kinematics
