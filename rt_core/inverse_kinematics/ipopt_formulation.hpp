// The nonlinear programs of inverse kinematics: objective, equations and their derivatives at a posture, and the best
// posture so far. Without Ipopt; internal to the folder.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/inverse_kinematics/ipopt_pose_model.hpp"
#include "rt_core/inverse_kinematics/ipopt_task_equations.hpp"
#include "rt_core/kinematics/task.hpp"

namespace cellmirror::inverse_kinematics {

enum class Objective : std::uint8_t {
  squared_error,  // of the required components; no equations; stops as soon as the task is met
  secondary,      // the required components are equations, half the squared distance() to Problem::wished is minimised
  orientation,    // the same, and the angle to the wanted orientation is minimised
};

// Which second derivatives the objective squared_error has; the others always have all of them.
enum class HessianChoice : std::uint8_t {
  exact,
  gauss_newton,  // without those of the pose in the joint values
  by_distance,   // Gauss-Newton far from the target, where the exact one is often indefinite, exact near it
};

// The input of one run.
struct Problem {
  Pose X_BG = Pose::Identity();
  kinematics::Task task;
  JointValues wished{};  // of the secondary objective: where the joints would like to be
  JointValues start{};
  double tolerance = 1e-5;
  const Clock* clock = nullptr;  // null: no deadline
  Timestamp deadline;
  int max_iterations = 60;
  bool to_the_end = false;  // squared_error: down to the local minimum, even if it is no solution
};

struct Run {
  JointValues q{};    // within the limits; the best so far
  double cost = 0.0;  // the objective at q
  bool met = false;   // q meets the required components, by task_error()
  bool timed_out = false;
  int iterations = 0;
};

class Formulation {
 public:
  Formulation(const kinematics::Chain& chain, Objective objective, HessianChoice hessian);

  // `problem` has to live until the next start().
  void start(const Problem& problem);

  [[nodiscard]] const Problem& problem() const { return *problem_; }
  [[nodiscard]] const kinematics::Chain& chain() const { return model_.chain(); }
  [[nodiscard]] int variable_count() const { return static_cast<int>(chain().variable_count()); }
  [[nodiscard]] int equation_count() const;

  // Each at the posture x; the objective notes x where that can be the solution.
  [[nodiscard]] double objective(std::span<const double> x);
  [[nodiscard]] Gradient objective_gradient(std::span<const double> x);
  void equations(std::span<const double> x, double* c);
  [[nodiscard]] Gradient equation_gradient(std::span<const double> x, int row);
  // Lower triangle of the Hessian of factor * objective + multipliers . equations.
  [[nodiscard]] Hessian lagrangian_hessian(std::span<const double> x, double factor, const double* multipliers);

  // After each iteration, with its number and the objective: false ends the run.
  [[nodiscard]] bool go_on(int iteration, double value);
  // x is the end of the run.
  void finish(std::span<const double> x, double value);

  [[nodiscard]] const Run& run() const { return run_; }

 private:
  [[nodiscard]] PoseFunction pose_cost() const;
  [[nodiscard]] bool gauss_newton(double cost) const;
  void note(std::span<const double> x, double value);
  [[nodiscard]] bool slow(double value);

  PoseModel model_;
  TaskEquations equations_;
  Objective objective_;
  HessianChoice hessian_;
  double position_weight_;      // 1 / m2
  JointValues joint_weight_{};  // of the secondary objective: 1 / rad2 or 1 / m2
  const Problem* problem_ = nullptr;
  Run run_;
  JointValues latest_{};  // of the last gradient: position of the run
  int slow_iterations_ = 0;
  double last_value_ = 0.0;
};

// What a squared metre counts against a squared radian (1 / m2).
[[nodiscard]] double position_weight(const kinematics::Chain& chain);

}  // namespace cellmirror::inverse_kinematics
