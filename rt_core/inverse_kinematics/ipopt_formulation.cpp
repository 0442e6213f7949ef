#include "rt_core/inverse_kinematics/ipopt_formulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rt_core/kinematics/reach.hpp"

namespace cellmirror::inverse_kinematics {

namespace {

// Measured on the arms of docs/decisions/0008-ipopt-in-parallel.md.
constexpr double kNearCost = 1e-4;     // of the squared error: below, the exact Hessian is used and no run is given up
constexpr double kDamping = 0.1;       // times the squared error (at most 1): vanishes at the solution, as it has to
constexpr double kSlowRatio = 0.7;     // an iteration that leaves more than this of the squared error
constexpr int kSlowIterations = 4;     // this often in a row: a local minimum is ahead
constexpr double kPositionWeight = 3;  // of the position error in units of length of the chain

}  // namespace

double position_weight(const kinematics::Chain& chain) {
  const double unit = kinematics::unit_of_length(chain);
  return kPositionWeight / (unit * unit);
}

Formulation::Formulation(const kinematics::Chain& chain, Objective objective, HessianChoice hessian)
    : model_(chain), objective_(objective), hessian_(hessian), position_weight_(position_weight(chain)) {
  const double unit = kinematics::unit_of_length(chain);
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    joint_weight_[i] = chain.rotates(i) ? 1.0 : 1.0 / (unit * unit);
  }
}

void Formulation::start(const Problem& problem) {
  problem_ = &problem;
  run_ = Run{};
  run_.q = problem.start;
  run_.cost = std::numeric_limits<double>::infinity();
  latest_ = problem.start;
  slow_iterations_ = 0;
  last_value_ = std::numeric_limits<double>::infinity();
  if (objective_ == Objective::squared_error) return;
  model_.place({problem.start.data(), chain().variable_count()});
  equations_ = TaskEquations(problem.task, problem.X_BG);
  equations_.keep_independent(model_);
}

int Formulation::equation_count() const { return objective_ == Objective::squared_error ? 0 : equations_.count(); }

PoseFunction Formulation::pose_cost() const {
  const Pose& X_BT = model_.X_BT();
  if (objective_ == Objective::secondary) return {};
  if (objective_ == Objective::orientation) return squared_orientation_error(problem_->task, X_BT, problem_->X_BG);
  return squared_task_error(problem_->task, X_BT, problem_->X_BG, position_weight_);
}

double Formulation::objective(std::span<const double> x) {
  model_.place(x);
  double value = pose_cost().value;
  if (objective_ == Objective::secondary) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double away = x[i] - problem_->wished[i];
      value += 0.5 * joint_weight_[i] * away * away;
    }
  }
  // Every posture that is tried is within the limits, so any of them may be the solution.
  if (objective_ == Objective::squared_error && std::isfinite(value)) note(x, value);
  return value;
}

Gradient Formulation::objective_gradient(std::span<const double> x) {
  model_.place(x);
  std::copy(x.begin(), x.end(), latest_.begin());
  Gradient gradient = Gradient::Zero(variable_count());
  if (objective_ == Objective::secondary) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      gradient[static_cast<Eigen::Index>(i)] = joint_weight_[i] * (x[i] - problem_->wished[i]);
    }
  } else {
    model_.add_gradient(pose_cost(), gradient);
  }
  return gradient;
}

void Formulation::equations(std::span<const double> x, double* c) {
  model_.place(x);
  equations_.values(model_.X_BT(), c);
}

Gradient Formulation::equation_gradient(std::span<const double> x, int row) {
  model_.place(x);
  Gradient gradient = Gradient::Zero(variable_count());
  model_.add_gradient(equations_.one(model_.X_BT(), row), gradient);
  return gradient;
}

bool Formulation::gauss_newton(double cost) const {
  if (objective_ != Objective::squared_error || problem_->to_the_end) return false;
  return hessian_ == HessianChoice::gauss_newton || (hessian_ == HessianChoice::by_distance && cost > kNearCost);
}

Hessian Formulation::lagrangian_hessian(std::span<const double> x, double factor, const double* multipliers) {
  model_.place(x);
  Hessian hessian = Hessian::Zero(variable_count(), variable_count());
  PoseFunction function = pose_cost();
  const double cost = function.value;
  function *= factor;
  if (equation_count() > 0) function += equations_.combined(model_.X_BT(), multipliers);
  model_.add_hessian(function, !gauss_newton(cost), hessian);
  if (objective_ == Objective::secondary) {
    for (Eigen::Index i = 0; i < hessian.rows(); ++i) {
      hessian(i, i) += factor * joint_weight_[static_cast<std::size_t>(i)];
    }
  }
  if (objective_ == Objective::squared_error) hessian.diagonal().array() += factor * kDamping * std::min(1.0, cost);
  return hessian;
}

bool Formulation::slow(double value) {
  slow_iterations_ = value > kSlowRatio * last_value_ && value > kNearCost ? slow_iterations_ + 1 : 0;
  last_value_ = value;
  return slow_iterations_ >= kSlowIterations;
}

bool Formulation::go_on(int iteration, double value) {
  run_.iterations = iteration;
  if (problem_->clock != nullptr && problem_->clock->now() >= problem_->deadline) run_.timed_out = true;
  if (objective_ != Objective::squared_error) {
    note({latest_.data(), chain().variable_count()}, value);
    return !run_.timed_out && iteration < problem_->max_iterations;
  }
  if (run_.met || run_.timed_out || iteration >= problem_->max_iterations) return false;
  return problem_->to_the_end || !slow(value);
}

void Formulation::finish(std::span<const double> x, double value) {
  if (std::isfinite(value)) note(x, value);
}

// A posture that meets the task is better than one that does not; among those that meet it, and for the squared error
// among the others, the lower objective.
void Formulation::note(std::span<const double> x, double value) {
  model_.place(x);
  const kinematics::Twist error = kinematics::task_error(problem_->task, model_.X_BT(), problem_->X_BG);
  const bool met = kinematics::meets(problem_->task, error, problem_->tolerance);
  const bool better = met == run_.met ? value < run_.cost : met;
  if (!better || (!met && objective_ != Objective::squared_error)) return;
  run_.met = met;
  run_.cost = value;
  std::copy(x.begin(), x.end(), run_.q.begin());
}

}  // namespace cellmirror::inverse_kinematics
