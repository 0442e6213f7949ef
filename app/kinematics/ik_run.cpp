#include "app/kinematics/ik_run.hpp"

#include <fmt/format.h>

#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::app {

namespace {

using inverse_kinematics::Answer;
using inverse_kinematics::Request;
using inverse_kinematics::Solver;

class Runner {
 public:
  Runner(const kinematics::Chain& chain, const IkSettings& settings, const Clock& clock)
      : chain_(chain), settings_(settings), clock_(clock) {
    request_.task = settings.task;
    request_.present = settings.start;
    request_.tolerance = settings.tolerance;
    request_.time_limit = settings.time_limit;
    request_.max_solutions = settings.max_solutions;
  }

  // Tables are built, memory is taken and code is loaded before anything is measured.
  Result<double> set_up() {
    const Timestamp start = clock_.now();
    solver_ = inverse_kinematics::make_solver(settings_.method, chain_, clock_);
    if (!solver_) return fail("there is no such method for this robot", "--method auto");
    JointValues q = chain_.middle();
    for (std::size_t i = 0; i < chain_.variable_count(); ++i) {
      constexpr double kAway = 0.1;  // of the way to the upper limit, so that the solution is not the start
      if (chain_.upper()[i] < 1e6) q[i] += kAway * (chain_.upper()[i] - q[i]);
    }
    request_.X_BG = kinematics::forward(chain_, used(q));
    if (const auto answer = solver_->solve(request_); !answer) return std::unexpected(answer.error());
    return 1e-3 * us_since(start);
  }

  Result<IkOutcome> solve(const Pose& X_BG, std::size_t& false_claims) {
    request_.X_BG = X_BG;
    const Timestamp start = clock_.now();
    const Result<Answer> answer = solver_->solve(request_);
    IkOutcome out;
    out.time_us = us_since(start);
    if (!answer) return std::unexpected(answer.error());
    out.timed_out = answer->timed_out;
    if (answer->solutions.empty()) return fail("the solver gave no posture", "this is a bug, please report it");
    fill(out, *answer, X_BG);
    if (answer->solved && !out.solved) ++false_claims;
    return out;
  }

 private:
  [[nodiscard]] double us_since(Timestamp start) const { return 1e6 * seconds(clock_.now() - start); }
  [[nodiscard]] std::span<const double> used(const JointValues& q) const { return {q.data(), chain_.variable_count()}; }

  void fill(IkOutcome& out, const Answer& answer, const Pose& X_BG) const {
    const inverse_kinematics::Solution& best = answer.solutions.front();
    out.q = best.q;
    const Pose X_BT = kinematics::forward(chain_, used(best.q));
    const kinematics::Twist error = kinematics::task_error(settings_.task, X_BT, X_BG);
    out.position_error_m = error.head<3>().norm();
    out.rotation_error_rad = error.tail<3>().norm();
    out.solved = answer.solved && holds(best.q, X_BG);
    if (!out.solved) return;
    out.by = best.by;
    for (const auto& other : std::span(answer.solutions).subspan(1)) {
      if (!holds(other.q, X_BG)) continue;
      const auto q = used(other.q);
      out.alternatives.insert(out.alternatives.end(), q.begin(), q.end());
    }
  }

  [[nodiscard]] bool holds(const JointValues& q, const Pose& X_BG) const {
    const Pose X_BT = kinematics::forward(chain_, used(q));
    return chain_.within_limits(used(q)) &&
           kinematics::meets(settings_.task, kinematics::task_error(settings_.task, X_BT, X_BG), settings_.tolerance);
  }

  const kinematics::Chain& chain_;
  const IkSettings& settings_;
  const Clock& clock_;
  Request request_;
  std::unique_ptr<Solver> solver_;
};

}  // namespace

Result<IkRun> run_ik(const kinematics::Chain& chain, const IkSettings& settings, std::span<const Pose> targets,
                     const Clock& clock, const Progress& progress) {
  Runner runner(chain, settings, clock);
  IkRun run;
  const auto setup_ms = runner.set_up();
  if (!setup_ms) return std::unexpected(setup_ms.error());
  run.setup_ms = *setup_ms;
  run.outcomes.reserve(targets.size());
  for (const Pose& X_BG : targets) {
    auto outcome = runner.solve(X_BG, run.false_claims);
    if (!outcome) {
      return fail(fmt::format("target {}: {}", run.outcomes.size() + 1, outcome.error().what), outcome.error().remedy);
    }
    run.outcomes.push_back(std::move(*outcome));
    constexpr std::size_t kEvery = 64;
    if (progress && run.outcomes.size() % kEvery == 0) progress(run.outcomes.size());
  }
  return run;
}

}  // namespace cellmirror::app
