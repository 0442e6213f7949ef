// Derivatives of the nonlinear programs against differences.
#include "rt_core/inverse_kinematics/ipopt_formulation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "tests/unit/inverse_kinematics/ipopt_arms.hpp"

namespace cellmirror::inverse_kinematics {
namespace {

using ipopt_test::odd_arm;
using ipopt_test::pose_at;
using ipopt_test::random_posture;
using kinematics::Chain;
using kinematics::OrientationTask;
using kinematics::Task;

constexpr double kStep = 1e-5;

class Derivatives : public testing::TestWithParam<OrientationTask> {
 protected:
  Derivatives() : chain_(odd_arm()), random_(9) {
    problem_.task.orientation = GetParam();
    problem_.tolerance = 1e-9;
    problem_.to_the_end = true;  // all second derivatives
  }
  void draw(double away) {
    const JointValues there = random_posture(chain_, random_, 0.8);
    const JointValues off = random_posture(chain_, random_, away);
    problem_.X_BG = pose_at(chain_, there);
    problem_.start = there;
    for (std::size_t i = 0; i < n(); ++i) problem_.start[i] += off[i] - chain_.middle()[i];
    problem_.wished = random_posture(chain_, random_);
  }
  [[nodiscard]] std::size_t n() const { return chain_.variable_count(); }
  [[nodiscard]] std::span<const double> view(const JointValues& q) const { return {q.data(), n()}; }

  // Compares gradient and Hessian of factor * objective + multipliers . equations with central differences.
  void compare(Formulation& sut, double factor, const std::vector<double>& multipliers) {
    const JointValues q = problem_.start;
    const auto gradient_at = [&](const JointValues& x) {
      Gradient g = factor * sut.objective_gradient(view(x));
      for (int row = 0; row < sut.equation_count(); ++row) {
        g += multipliers[static_cast<std::size_t>(row)] * sut.equation_gradient(view(x), row);
      }
      return g;
    };
    const auto value_at = [&](const JointValues& x) {
      double value = factor * sut.objective(view(x));
      std::array<double, 6> c{};
      sut.equations(view(x), c.data());
      for (int row = 0; row < sut.equation_count(); ++row) {
        value += multipliers[static_cast<std::size_t>(row)] * c[static_cast<std::size_t>(row)];
      }
      return value;
    };
    const Gradient gradient = gradient_at(q);
    const double damping = sut.equation_count() == 0 ? factor * 0.1 * std::min(1.0, sut.objective(view(q))) : 0.0;
    const Hessian hessian = sut.lagrangian_hessian(view(q), factor, multipliers.data());
    for (std::size_t i = 0; i < n(); ++i) {
      JointValues up = q;
      JointValues down = q;
      up[i] += kStep;
      down[i] -= kStep;
      const auto column = static_cast<Eigen::Index>(i);
      EXPECT_NEAR(gradient[column], (value_at(up) - value_at(down)) / (2 * kStep), 2e-7);
      const Gradient second = (gradient_at(up) - gradient_at(down)) / (2 * kStep);
      for (Eigen::Index row = column; row < hessian.rows(); ++row) {
        const double extra = row == column ? damping : 0.0;
        EXPECT_NEAR(hessian(row, column) - extra, second[row], 2e-5) << row << ", " << column;
      }
    }
  }

  Chain chain_;
  std::mt19937_64 random_;
  Problem problem_;
};

TEST_P(Derivatives, OfTheSquaredError) {
  for (int round = 0; round < 10; ++round) {
    problem_.task.position_axes = static_cast<std::uint8_t>(round % 8);
    draw(0.15);
    Formulation sut(chain_, Objective::squared_error, HessianChoice::exact);
    sut.start(problem_);
    compare(sut, 1.7, {});
  }
}

TEST_P(Derivatives, OfTheEquations) {
  for (int round = 0; round < 10; ++round) {
    draw(0.15);
    Formulation sut(chain_, Objective::secondary, HessianChoice::exact);
    sut.start(problem_);
    compare(sut, 0.8, {0.3, -0.2, 0.7, 0.5, -0.6, 0.4});
  }
}

INSTANTIATE_TEST_SUITE_P(Ipopt, Derivatives,
                         testing::Values(OrientationTask::free, OrientationTask::full, OrientationTask::normal,
                                         OrientationTask::sliding, OrientationTask::approach));

TEST(IpoptFormulation, LeavesOutEquationsThatNothingCanChange) {
  const Chain chain = ipopt_test::planar_arm(4);
  Problem problem;
  problem.start = {0.3, 0.4, -0.5, 0.2};
  problem.X_BG = pose_at(chain, problem.start);
  Formulation sut(chain, Objective::secondary, HessianChoice::exact);
  sut.start(problem);
  EXPECT_EQ(sut.equation_count(), 3);  // x, y, and the heading
  problem.task.orientation = OrientationTask::free;
  sut.start(problem);
  EXPECT_EQ(sut.equation_count(), 2);
}

}  // namespace
}  // namespace cellmirror::inverse_kinematics
