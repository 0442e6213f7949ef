// Every arm beside KDL on the same targets: the small version of tests/bench/inverse_kinematics.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "rt_core/inverse_kinematics/inverse_kinematics.hpp"
#include "tests/bench/inverse_kinematics/arms.hpp"
#include "tests/bench/inverse_kinematics/kdl_solvers.hpp"

namespace cellmirror::inverse_kinematics {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kTargets = 500;
constexpr double kTolerance = 1e-5;

struct Tally {
  std::size_t solved = 0;
  std::size_t false_claims = 0;
  double median_us = 0;
};

bool is_solution(const kinematics::Chain& chain, const JointValues& q, const Pose& X_BG) {
  const std::span<const double> values(q.data(), chain.variable_count());
  return chain.within_limits(values) &&
         kinematics::pose_error(kinematics::forward(chain, values), X_BG).cwiseAbs().maxCoeff() <= kTolerance;
}

template <typename Search>
Tally tally_of(const kinematics::Chain& chain, std::size_t targets, Search&& search) {
  Tally tally;
  std::vector<double> us;
  for (const JointValues& there : test_arms::random_postures(chain, targets, 99)) {
    const Pose X_BG = kinematics::forward(chain, {there.data(), chain.variable_count()});
    JointValues q{};
    const auto begin = Clock::now();
    const bool claimed = search(X_BG, q);
    us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
    const bool good = is_solution(chain, q, X_BG);
    tally.solved += claimed && good ? 1U : 0U;
    tally.false_claims += claimed && !good ? 1U : 0U;
  }
  std::nth_element(us.begin(), us.begin() + static_cast<std::ptrdiff_t>(us.size() / 2), us.end());
  tally.median_us = us[us.size() / 2];
  return tally;
}

void compare_with_kdl(const test_arms::Arm& arm) {
  SCOPED_TRACE(arm.name);
  const auto solver = make_solver(Method::automatic, arm.chain, test_arms::kClock);
  const Tally ours = tally_of(arm.chain, kTargets, [&](const Pose& X_BG, JointValues& q) {
    Request request;
    request.X_BG = X_BG;
    request.present = arm.chain.middle();
    request.tolerance = kTolerance;
    request.time_limit = std::chrono::milliseconds(500);  // a busy machine decides nothing
    const Answer answer = solver->solve(request).value();
    q = answer.solutions.front().q;
    return answer.solved;
  });
  EXPECT_EQ(ours.false_claims, 0U);
  EXPECT_EQ(ours.solved, kTargets);

  constexpr std::size_t kKdlTargets = 50;  // up to 5 ms each
  test_arms::KdlSolvers kdl(arm.chain, kTolerance, 0.005);
  const Tally theirs = tally_of(arm.chain, kKdlTargets, [&](const Pose& X_BG, JointValues& q) {
    return kdl.joint_limited(X_BG, arm.chain.middle(), q);
  });
  EXPECT_LE(theirs.solved * kTargets, ours.solved * kKdlTargets);
#ifndef CELLMIRROR_SANITIZED
  EXPECT_LT(ours.median_us, theirs.median_us);
#endif
}

TEST(AllArms, AutoSolvesEveryTargetOfTheSharedArms) {
  const auto arms = test_arms::shared_arms();
  if (arms.empty()) GTEST_SKIP() << "skipped: the shared data with the robots is not on this machine";
  for (const test_arms::Arm& arm : arms) compare_with_kdl(arm);
}

TEST(AllArms, AutoSolvesEveryTargetOfArmsThatNobodyTunedItFor) {
  for (const test_arms::Arm& arm : test_arms::unseen_arms()) compare_with_kdl(arm);
}

}  // namespace
}  // namespace cellmirror::inverse_kinematics
