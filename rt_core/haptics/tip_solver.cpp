#include "rt_core/haptics/tip_solver.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace cellmirror::haptics {

namespace {

constexpr int kMaxIterations = 8;
constexpr double kMet = 1e-6;          // m
constexpr double kEnough = 1e-9;       // m
constexpr double kEnoughTurn = 1e-5;   // rad: a change of roll that is worth another step
constexpr double kTurnDamping = 1e-3;  // rad2: what no motion can take off must not be blown up
constexpr double kLongestStep = 0.3;   // rad or m, of one variable in one iteration
constexpr double kLargestTurn = 0.1;   // rad, likewise, for the orientation

using Columns =
    Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, static_cast<int>(kinematics::kMaxVariables)>;
using Step = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, static_cast<int>(kinematics::kMaxVariables), 1>;

Eigen::Matrix3d damped_inverse(const Columns& J, double damping) CELL_RT {
  // Coefficient by coefficient: for long chains Eigen would take its blocked product, which may use the heap.
  Eigen::Matrix3d A = J.lazyProduct(J.transpose());
  A.diagonal().array() += damping;
  return A.inverse();
}

// One step of all variables; those that reach a limit stop there, and the others make up for it.
class Stepper {
 public:
  Stepper(const kinematics::Jacobian& J, const TipFreedom& freedom, std::span<const double> q)
      : freedom_(freedom), q_(q), place_(J.topRows<3>()), turn_(J.bottomRows<3>()), all_turn_(turn_) {
    step_ = Step::Zero(place_.cols());
    for (Eigen::Index i = 0; i < place_.cols(); ++i) {
      if ((freedom.fixed >> i & 1U) != 0) hold(i);
    }
  }

  // Takes error (m) off the tip's place.
  void approach(const Eigen::Vector3d& error) CELL_RT {
    Eigen::Vector3d left = error;
    for (Eigen::Index pass = 0; pass <= place_.cols(); ++pass) {
      const Step wanted = place_.transpose() * (damped_inverse(place_, kPlaceDamping) * left);
      const Step allowed = within(wanted);
      bool stopped = false;
      for (Eigen::Index i = 0; i < place_.cols(); ++i) {
        if (allowed[i] == wanted[i]) continue;
        left -= place_.col(i) * allowed[i];
        step_[i] += allowed[i];
        hold(i);
        stopped = true;
      }
      if (stopped) continue;
      step_ += allowed;
      return;
    }
  }

  // Takes what can be taken off the orientation's error (rad) by motions that leave the place alone.
  void turn(const Eigen::Vector3d& error) CELL_RT {
    const Columns projected =
        turn_ - turn_.lazyProduct(place_.transpose()).eval() * damped_inverse(place_, kPlaceDamping) * place_;
    const Eigen::Vector3d left = error - all_turn_ * step_;
    Step wanted = projected.transpose() * (damped_inverse(projected, kTurnDamping) * left);
    // Once more, since damping has let a trace of what moves the place through.
    wanted -= place_.transpose() * (damped_inverse(place_, kPlaceDamping) * (place_ * wanted));
    const double largest = wanted.cwiseAbs().maxCoeff();
    if (largest > kLargestTurn) wanted *= kLargestTurn / largest;
    // A limit in the way shortens the motion as a whole, so that it still leaves the place alone.
    double share = 1.0;
    const Step allowed = within(wanted);
    for (Eigen::Index i = 0; i < wanted.size(); ++i) {
      if (wanted[i] != 0) share = std::min(share, std::clamp(allowed[i] / wanted[i], 0.0, 1.0));
    }
    step_ += share * wanted;
    turned_ = share * wanted.cwiseAbs().maxCoeff();
  }

  [[nodiscard]] const Step& step() const CELL_RT { return step_; }
  [[nodiscard]] double turned() const CELL_RT { return turned_; }

 private:
  void hold(Eigen::Index i) CELL_RT {
    place_.col(i).setZero();
    turn_.col(i).setZero();
  }

  Step within(const Step& wanted) const CELL_RT {
    Step allowed(wanted.size());
    for (Eigen::Index i = 0; i < wanted.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double now = q_[k] + step_[i];
      const double limited = std::clamp(wanted[i], -kLongestStep, kLongestStep);
      allowed[i] =
          limited == 0 ? limited : std::min(std::max(now + limited, freedom_.lower[k]), freedom_.upper[k]) - now;
      if (std::abs(allowed[i] - wanted[i]) < 1e-15) allowed[i] = wanted[i];
    }
    return allowed;
  }

  TipFreedom freedom_;
  std::span<const double> q_;
  Columns place_;
  Columns turn_;
  Columns all_turn_;  // with those that are held
  Step step_;
  double turned_ = 0;
};

}  // namespace

TipPosture solve_tip(const kinematics::Chain& chain, const TipGoal& goal, const TipFreedom& freedom,
                     std::span<double> q) CELL_RT {
  const std::size_t n = chain.variable_count();
  TipPosture best;
  JointValues best_q{};
  bool oriented = !goal.orient;
  for (int i = 0; i <= kMaxIterations; ++i) {
    TipPosture now;
    now.X_BE = kinematics::forward(chain, q, now.J);
    const Eigen::Vector3d error = goal.p_BE - now.X_BE.translation();
    now.error = error.norm();
    if (i == 0 || now.error <= std::max(best.error, kEnough)) {
      best = now;
      std::copy_n(q.begin(), n, best_q.begin());
    }
    if (i == kMaxIterations || (now.error <= kEnough && oriented)) break;
    Stepper stepper(now.J, freedom, q);
    stepper.approach(error);
    if (goal.orient) {
      const Eigen::AngleAxisd rest(Eigen::Matrix3d(goal.R_BE * now.X_BE.linear().transpose()));
      stepper.turn(rest.angle() * rest.axis());
      oriented = stepper.turned() < kEnoughTurn;
    }
    for (std::size_t k = 0; k < n; ++k) {
      q[k] =
          std::min(std::max(q[k] + stepper.step()[static_cast<Eigen::Index>(k)], freedom.lower[k]), freedom.upper[k]);
    }
  }
  std::copy_n(best_q.begin(), n, q.begin());
  best.met = best.error <= kMet;
  return best;
}

}  // namespace cellmirror::haptics
