// What Ipopt's searches promise beyond what every method does.
#include "rt_core/inverse_kinematics/ipopt_solver.hpp"

#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/unit/inverse_kinematics/ipopt_arms.hpp"

namespace cellmirror::inverse_kinematics {
namespace {

using ipopt_test::odd_arm;
using ipopt_test::planar_arm;
using ipopt_test::pose_at;
using ipopt_test::random_posture;
using ipopt_test::wrist_arm;
using kinematics::Chain;
using kinematics::OrientationTask;
using kinematics::Secondary;
using kinematics::Twist;

// Long enough that a busy machine decides nothing.
constexpr std::chrono::microseconds kPatience = std::chrono::seconds(5);

Request request_for(const Chain& chain, const Pose& X_BG) {
  Request request;
  request.X_BG = X_BG;
  request.present = chain.middle();
  request.time_limit = kPatience;
  return request;
}

Request point_request(const Chain& chain, double x, double y) {
  Request request = request_for(chain, pose_from_xyz_rpy({x, y, 0}, {0, 0, 0}));
  request.task.orientation = OrientationTask::free;
  return request;
}

void expect_sound(const Chain& chain, const Request& request, const Answer& answer) {
  ASSERT_FALSE(answer.solutions.empty());
  for (const Solution& solution : answer.solutions) {
    EXPECT_TRUE(chain.within_limits({solution.q.data(), chain.variable_count()}));
    const Twist error = kinematics::task_error(request.task, pose_at(chain, solution.q), request.X_BG);
    EXPECT_LT((error - solution.error).norm(), 1e-9);
    EXPECT_EQ(answer.solved, kinematics::meets(request.task, error, request.tolerance));
    EXPECT_EQ(solution.by, answer.solved ? FoundBy::ipopt : FoundBy::nobody);
  }
}

TEST(IpoptSolver, FindsBothPosturesOfATwoJointArm) {
  const Chain chain = planar_arm(2);
  const auto sut = make_ipopt_solver(chain, ipopt_test::kClock, {});
  for (const double radius : {0.6, 1.2, 1.9}) {
    const double heading = 0.4;
    Request request = point_request(chain, radius * std::cos(heading), radius * std::sin(heading));
    request.max_solutions = 4;
    const Answer answer = sut->solve(request).value();
    expect_sound(chain, request, answer);
    ASSERT_TRUE(answer.solved);
    ASSERT_EQ(answer.solutions.size(), 2U) << radius;
    const double bend = 2 * std::acos(radius / 2);  // law of cosines, links of 1 m
    for (const Solution& solution : answer.solutions) {
      EXPECT_NEAR(std::abs(solution.q[1]), bend, 1e-4);
      EXPECT_NEAR(solution.q[0], heading - solution.q[1] / 2, 1e-4);
    }
    EXPECT_LT(answer.solutions[0].q[1] * answer.solutions[1].q[1], 0);
  }
}

// Three joints reach a point in a whole family of postures: the least squared distance from the present posture is
// known from trying all headings of the last link.
TEST(IpoptSolver, ResolvesRedundancyByTheDistanceFromThePresentPosture) {
  const Chain chain = planar_arm(3);
  const auto sut = make_ipopt_solver(chain, ipopt_test::kClock, {});
  std::mt19937_64 random(17);
  int at_the_minimum = 0;
  constexpr int kRounds = 40;
  for (int round = 0; round < kRounds; ++round) {
    const JointValues there = random_posture(chain, random, 0.6);
    const Eigen::Vector3d p = pose_at(chain, there).translation();
    Request request = point_request(chain, p.x(), p.y());
    request.present = there;
    for (std::size_t i = 0; i < 3; ++i) request.present[i] += std::uniform_real_distribution<>(-0.3, 0.3)(random);
    const Answer answer = sut->solve(request).value();
    expect_sound(chain, request, answer);
    ASSERT_TRUE(answer.solved);

    double least = std::numeric_limits<double>::infinity();
    for (int step = 0; step < 20'000; ++step) {
      const double heading = step * 2 * std::numbers::pi / 20'000;
      const double x = p.x() - std::cos(heading);
      const double y = p.y() - std::sin(heading);
      const double radius = std::hypot(x, y);
      if (radius > 2) continue;
      for (const double sign : {-1.0, 1.0}) {
        const double q1 = sign * 2 * std::acos(radius / 2);
        const double q0 = std::remainder(std::atan2(y, x) - q1 / 2, 2 * std::numbers::pi);
        const double q2 = std::remainder(heading - q0 - q1, 2 * std::numbers::pi);
        if (std::max({std::abs(q0), std::abs(q1), std::abs(q2)}) > 3.0) continue;
        least = std::min(least, std::hypot(q0 - request.present[0], q1 - request.present[1], q2 - request.present[2]));
      }
    }
    const JointValues& q = answer.solutions[0].q;
    const double distance = std::hypot(q[0] - request.present[0], q[1] - request.present[1], q[2] - request.present[2]);
    EXPECT_GT(distance, least - 2e-3);  // the headings are steps apart
    at_the_minimum += distance < least + 2e-3 ? 1 : 0;
  }
  EXPECT_GE(at_the_minimum, kRounds - 1);  // a local minimum may be another one
}

TEST(IpoptSolver, BendsABoomEvenly) {
  const Chain chain = planar_arm(5);
  const auto sut = make_ipopt_solver(chain, ipopt_test::kClock, {});
  Request request = point_request(chain, 3.0, 2.0);
  request.task.secondary = Secondary::even_bend;
  request.present = {1.0, -0.5, 1.0, -0.8, 0.9};
  const Answer answer = sut->solve(request).value();
  expect_sound(chain, request, answer);
  ASSERT_TRUE(answer.solved);
  // Nothing along the postures that reach the point lowers the sum of squares: the gradient q is a combination of the
  // rows of the Jacobian.
  kinematics::Jacobian J;
  (void)kinematics::forward(chain, {answer.solutions[0].q.data(), 5}, J);
  Eigen::Matrix<double, 5, 1> q;
  for (int i = 0; i < 5; ++i) q[i] = answer.solutions[0].q[static_cast<std::size_t>(i)];
  const Eigen::MatrixXd rows = J.topRows<2>();
  const Eigen::VectorXd along = q - rows.transpose() * (rows * rows.transpose()).inverse() * (rows * q);
  EXPECT_LT(along.norm(), 1e-3);
}

TEST(IpoptSolver, KeepsLimitsThatTheSolutionTouches) {
  const Chain wide = planar_arm(2);
  const JointValues there = {0.5, 1.0};
  const std::vector<double> lower = {-3.0, -3.0};
  const std::vector<double> upper = {0.5, 1.0};
  const Chain chain = wide.with_limits(lower, upper).value();
  const auto sut = make_ipopt_solver(chain, ipopt_test::kClock, {});
  const Eigen::Vector3d p = pose_at(chain, there).translation();
  Request request = point_request(chain, p.x(), p.y());
  request.present = {-2.0, 0.9};
  const Answer answer = sut->solve(request).value();
  expect_sound(chain, request, answer);
  EXPECT_TRUE(answer.solved);
}

TEST(IpoptSolver, MeetsEveryClassOfTasks) {
  std::mt19937_64 random(5);
  for (const Chain& chain : {wrist_arm(), odd_arm()}) {
    const auto sut = make_ipopt_solver(chain, ipopt_test::kClock, {});
    for (int axes = 0; axes < 8; ++axes) {
      for (const OrientationTask orientation : {OrientationTask::free, OrientationTask::full, OrientationTask::normal,
                                                OrientationTask::sliding, OrientationTask::approach}) {
        for (const bool required : {true, false}) {
          Request request = request_for(chain, pose_at(chain, random_posture(chain, random, 0.9)));
          request.task.position_axes = static_cast<std::uint8_t>(axes);
          request.task.orientation = orientation;
          request.task.orientation_required = required;
          const Answer answer = sut->solve(request).value();
          expect_sound(chain, request, answer);
          EXPECT_TRUE(answer.solved) << axes << " " << static_cast<int>(orientation) << " " << required;
        }
      }
    }
  }
}

TEST(IpoptSolver, TurnsAnAttemptedOrientationAsNearAsThePositionAllows) {
  const Chain chain = planar_arm(3);
  const auto sut = make_ipopt_solver(chain, ipopt_test::kClock, {});
  Request request = request_for(chain, pose_from_xyz_rpy({1.5, 0.8, 0}, {0, 0, 1.2}));
  request.task.orientation_required = false;
  Answer answer = sut->solve(request).value();
  ASSERT_TRUE(answer.solved);
  EXPECT_LT(answer.solutions[0].error.tail<3>().norm(), 1e-4);  // within its dexterous reach

  // Nearly stretched: the last link can turn little. The best heading is known from trying all of them.
  const double x = 2.9;
  request.X_BG = pose_from_xyz_rpy({x, 0, 0}, {0, 0, 1.2});
  answer = sut->solve(request).value();
  expect_sound(chain, request, answer);
  ASSERT_TRUE(answer.solved);
  // The first two links reach at most 2 m: cos(heading) >= (x^2 + 1 - 4) / (2 x).
  const double widest = std::acos((x * x - 3) / (2 * x));
  EXPECT_NEAR(answer.solutions[0].error.tail<3>().norm(), 1.2 - widest, 1e-3);
}

TEST(IpoptSolver, GivesTheNearestPoseOfATargetOutOfReach) {
  const Chain chain = planar_arm(3);
  const auto sut = make_ipopt_solver(chain, ipopt_test::kClock, {});
  Request request = point_request(chain, 3.0, 4.0);  // 5 m away; the arm reaches 3
  request.time_limit = std::chrono::milliseconds(100);
  const Answer answer = sut->solve(request).value();
  expect_sound(chain, request, answer);
  EXPECT_FALSE(answer.solved);
  EXPECT_NEAR(answer.solutions.at(0).error.head<3>().norm(), 2.0, 1e-3);
}

// Processor time: what others do meanwhile is not the search's fault, and can only end it sooner.
double processor_ms() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

TEST(IpoptSolver, KeepsItsTimeLimit) {
  const Chain chain = odd_arm();
  const auto sut = make_ipopt_solver(chain, ipopt_test::kClock, {});
  Request request = request_for(chain, pose_from_xyz_rpy({30, 0, 0}, {0, 0, 0}));
  std::vector<double> ms;
  for (int round = 0; round < 21; ++round) {
    request.time_limit = std::chrono::milliseconds(5);
    const double start = processor_ms();
    const Answer answer = sut->solve(request).value();
    ms.push_back(processor_ms() - start);
    EXPECT_TRUE(answer.timed_out);
    EXPECT_FALSE(answer.solved);
  }
  std::sort(ms.begin(), ms.end());
#ifndef CELLMIRROR_SANITIZED
  EXPECT_LT(ms[10], 6.0);
#endif
}

TEST(IpoptSolver, SolvesAChainThatCannotMove) {
  Chain chain = planar_arm(2);
  const std::vector<double> fixed = {0.3, 0.4};
  chain = chain.with_limits(fixed, fixed).value();
  const auto sut = make_ipopt_solver(chain, ipopt_test::kClock, {});
  const Request there = request_for(chain, pose_at(chain, {0.3, 0.4}));
  expect_sound(chain, there, sut->solve(there).value());
  EXPECT_TRUE(sut->solve(there)->solved);
  const Request elsewhere = request_for(chain, pose_at(chain, {0.3, 0.5}));
  expect_sound(chain, elsewhere, sut->solve(elsewhere).value());
  EXPECT_FALSE(sut->solve(elsewhere)->solved);
}

TEST(IpoptSolver, SolvesWithOneJointHeldByItsLimits) {
  const Chain wide = odd_arm();
  std::vector<double> lower(wide.lower().begin(), wide.lower().end());
  std::vector<double> upper(wide.upper().begin(), wide.upper().end());
  lower[3] = upper[3] = 0.7;
  const Chain chain = wide.with_limits(lower, upper).value();
  const auto sut = make_ipopt_solver(chain, ipopt_test::kClock, {});
  std::mt19937_64 random(8);
  for (int round = 0; round < 20; ++round) {
    const Request request = request_for(chain, pose_at(chain, random_posture(chain, random)));
    const Answer answer = sut->solve(request).value();
    expect_sound(chain, request, answer);
    EXPECT_TRUE(answer.solved);
  }
}

TEST(IpoptSolver, MeetsATighterTolerance) {
  const Chain chain = odd_arm();
  const auto sut = make_ipopt_solver(chain, ipopt_test::kClock, {});
  std::mt19937_64 random(12);
  for (int round = 0; round < 20; ++round) {
    Request request = request_for(chain, pose_at(chain, random_posture(chain, random, 0.9)));
    request.tolerance = 1e-9;
    const Answer answer = sut->solve(request).value();
    expect_sound(chain, request, answer);
    EXPECT_TRUE(answer.solved);
  }
}

TEST(IpoptSolver, AgreesWithItsOwnLinearSolver) {
  const Chain chain = wrist_arm();
  const auto sut = make_ipopt_solver(chain, ipopt_test::kClock, {});
  const auto reference = make_ipopt_solver(chain, ipopt_test::kClock,
                                           {.linear_solver = IpoptSettings::LinearSolver::mumps, .hessian = {}});
  std::mt19937_64 random(21);
  for (int round = 0; round < 20; ++round) {
    const Request request = request_for(chain, pose_at(chain, random_posture(chain, random, 0.8)));
    const Answer ours = sut->solve(request).value();
    const Answer theirs = reference->solve(request).value();
    EXPECT_TRUE(ours.solved);
    EXPECT_TRUE(theirs.solved);
  }
}

}  // namespace
}  // namespace cellmirror::inverse_kinematics
