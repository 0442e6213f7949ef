// What every method promises, on arms with and without a closed form.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "rt_core/inverse_kinematics/inverse_kinematics.hpp"
#include "rt_core/kinematics/reach.hpp"
#include "tests/bench/inverse_kinematics/arms.hpp"

namespace cellmirror::inverse_kinematics {
namespace {

using kinematics::Chain;
using kinematics::OrientationTask;
using kinematics::Twist;
using std::chrono::microseconds;
using std::chrono::milliseconds;

// Long enough that a busy machine decides nothing.
constexpr microseconds kPatience = std::chrono::seconds(2);

Pose pose_at(const Chain& chain, const JointValues& q) {
  return kinematics::forward(chain, {q.data(), chain.variable_count()});
}

Request request_for(const Chain& chain, const Pose& X_BG) {
  Request request;
  request.X_BG = X_BG;
  request.present = chain.middle();
  request.time_limit = kPatience;
  return request;
}

bool holds(const Chain& chain, const Request& request, const Solution& solution) {
  const Twist error = kinematics::task_error(request.task, pose_at(chain, solution.q), request.X_BG);
  return chain.within_limits({solution.q.data(), chain.variable_count()}) &&
         kinematics::meets(request.task, error, request.tolerance) && error.isApprox(solution.error, 1e-9);
}

double apart(const Chain& chain, const JointValues& a, const JointValues& b) {
  double sum = 0;
  for (std::size_t i = 0; i < chain.variable_count(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

class EveryMethod : public testing::TestWithParam<Method> {
 protected:
  [[nodiscard]] std::unique_ptr<Solver> make(const Chain& chain) const {
    return make_solver(GetParam(), chain, test_arms::kClock);
  }
};

TEST_P(EveryMethod, FindsPosturesOfPosesWithinTheLimits) {
  for (const test_arms::Arm& arm : test_arms::unseen_arms()) {
    const auto sut = make(arm.chain);
    for (const JointValues& there : test_arms::random_postures(arm.chain, 20, 21)) {
      const Request request = request_for(arm.chain, pose_at(arm.chain, there));
      const Answer answer = sut->solve(request).value();
      ASSERT_TRUE(answer.solved) << arm.name;
      ASSERT_EQ(answer.solutions.size(), 1U);
      EXPECT_TRUE(holds(arm.chain, request, answer.solutions[0])) << arm.name;
      EXPECT_NE(answer.solutions[0].by, FoundBy::nobody);
    }
  }
}

TEST_P(EveryMethod, SameInputGivesTheSameOutput) {
  const test_arms::Arm arm = test_arms::random_arm(7, 3);
  const auto sut = make(arm.chain);
  const auto other = make(arm.chain);
  const auto postures = test_arms::random_postures(arm.chain, 20, 5);
  for (const JointValues& there : postures) {
    const Request request = request_for(arm.chain, pose_at(arm.chain, there));
    const Answer first = sut->solve(request).value();
    (void)sut->solve(request_for(arm.chain, pose_at(arm.chain, postures[0])));
    const Answer again = sut->solve(request).value();
    const Answer elsewhere = other->solve(request).value();
    EXPECT_EQ(first.solutions[0].q, again.solutions[0].q);
    EXPECT_EQ(first.iterations, again.iterations);
    EXPECT_EQ(first.solutions[0].q, elsewhere.solutions[0].q);
  }
}

TEST_P(EveryMethod, NearTargetGivesTheNearPosture) {
  for (const test_arms::Arm& arm : test_arms::unseen_arms()) {
    const auto sut = make(arm.chain);
    std::mt19937_64 random(9);
    for (JointValues there : test_arms::random_postures(arm.chain, 10, 13)) {
      Request request = request_for(arm.chain, Pose::Identity());
      request.present = there;
      for (std::size_t i = 0; i < arm.chain.variable_count(); ++i) {
        there[i] += std::uniform_real_distribution<double>(-1e-3, 1e-3)(random);
        there[i] = std::clamp(there[i], arm.chain.lower()[i], arm.chain.upper()[i]);
      }
      request.X_BG = pose_at(arm.chain, there);
      const Answer answer = sut->solve(request).value();
      ASSERT_TRUE(answer.solved) << arm.name;
      EXPECT_LE(apart(arm.chain, answer.solutions[0].q, request.present), 0.2) << arm.name;
    }
  }
}

TEST_P(EveryMethod, OutOfReachIsRefusedWithTheNearestPose) {
  for (const test_arms::Arm& arm : test_arms::unseen_arms()) {
    const auto sut = make(arm.chain);
    const double away = kinematics::reach_bound(arm.chain) + 1.0;
    const Pose X_BG(Eigen::Translation3d(away, 0, 0));
    Request request = request_for(arm.chain, X_BG);
    request.task.orientation = OrientationTask::free;
    request.time_limit = milliseconds(100);
    const Answer answer = sut->solve(request).value();
    EXPECT_FALSE(answer.solved) << arm.name;
    ASSERT_EQ(answer.solutions.size(), 1U);
    EXPECT_EQ(answer.solutions[0].by, FoundBy::nobody);
    const std::span<const double> q(answer.solutions[0].q.data(), arm.chain.variable_count());
    EXPECT_TRUE(arm.chain.within_limits(q));
    const double miss = answer.solutions[0].error.head<3>().norm();
    EXPECT_GT(miss, 0.5);
    EXPECT_LT(miss, away + kinematics::reach_bound(arm.chain));
  }
}

TEST_P(EveryMethod, PlanarArmStretchesTowardsATargetOutOfReach) {
  std::vector<kinematics::ChainJoint> joints(3);
  std::vector<kinematics::Variable> variables;
  for (std::uint8_t i = 0; i < 3; ++i) {
    joints[i].variable = i;
    if (i > 0) joints[i].X_PJ = Pose(Eigen::Translation3d(1, 0, 0));
    variables.push_back({"q", JointKind::revolute, -3, 3});
  }
  const Chain chain = Chain::make(variables, joints, Pose(Eigen::Translation3d(1, 0, 0))).value();
  Request request = request_for(chain, Pose(Eigen::Translation3d(3, 4, 0)));
  request.task.orientation = OrientationTask::free;
  request.present = {0.5, 0.5, 0.5};
  const Answer answer = make(chain)->solve(request).value();
  EXPECT_FALSE(answer.solved);
  EXPECT_NEAR(answer.solutions[0].error.head<3>().norm(), 2.0, 1e-2);
}

TEST_P(EveryMethod, KeepsTheTimeLimit) {
  const test_arms::Arm arm = test_arms::random_arm(8, 2);
  const auto sut = make(arm.chain);
  std::vector<double> over;
  for (int i = 0; i < 20; ++i) {
    Request request = request_for(arm.chain, Pose(Eigen::Translation3d(0.1 * i, 100, 0)));
    request.time_limit = milliseconds(2);
    const auto begin = std::chrono::steady_clock::now();
    const Answer answer = sut->solve(request).value();
    EXPECT_FALSE(answer.solved);
    over.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
  }
  // The best of many: a machine that does other things meanwhile is no fault of the search.
  EXPECT_LT(*std::min_element(over.begin(), over.end()), 4.0);
}

// An hour passes between any two readings of it.
struct HastyClock final : Clock {
  [[nodiscard]] Timestamp now() const CELL_RT override {
    time = time + std::chrono::hours(1);
    return time;
  }
  mutable Timestamp time{1};
};

TEST_P(EveryMethod, ATimeLimitIsMeasuredByTheClockThatWasGiven) {
  const test_arms::Arm arm = test_arms::random_arm(8, 2);
  Request request = request_for(arm.chain, Pose(Eigen::Translation3d(0.1, 100, 0)));
  request.time_limit = milliseconds(2);
  const HastyClock hasty;
  EXPECT_TRUE(make_solver(GetParam(), arm.chain, hasty)->solve(request).value().timed_out);
  request.time_limit = microseconds(1);
  const ManualClock standing;
  EXPECT_FALSE(make_solver(GetParam(), arm.chain, standing)->solve(request).value().timed_out);
}

TEST_P(EveryMethod, TargetsAtTheLimitsAreSolved) {
  for (const test_arms::Arm& arm : test_arms::unseen_arms()) {
    const auto sut = make(arm.chain);
    std::mt19937_64 random(31);
    for (JointValues there : test_arms::random_postures(arm.chain, 8, 17)) {
      for (std::size_t i = 0; i < arm.chain.variable_count(); ++i) {
        if (!std::isfinite(arm.chain.lower()[i])) continue;
        const auto side = random() % 3;
        if (side == 0) there[i] = arm.chain.lower()[i];
        if (side == 1) there[i] = arm.chain.upper()[i];
      }
      const Request request = request_for(arm.chain, pose_at(arm.chain, there));
      const Answer answer = sut->solve(request).value();
      EXPECT_TRUE(answer.solved && holds(arm.chain, request, answer.solutions[0])) << arm.name;
    }
  }
}

TEST_P(EveryMethod, SingularTargetsAreSolved) {
  for (const test_arms::Arm& arm : test_arms::unseen_arms()) {
    const auto sut = make(arm.chain);
    for (JointValues there : test_arms::random_postures(arm.chain, 8, 19)) {
      for (std::size_t i = 0; i < arm.chain.variable_count(); i += 2) {  // straight elbows and wrists
        there[i] = std::clamp(std::numbers::pi / 2 * std::round(there[i] / (std::numbers::pi / 2)),
                              arm.chain.lower()[i], arm.chain.upper()[i]);
      }
      const Request request = request_for(arm.chain, pose_at(arm.chain, there));
      const Answer answer = sut->solve(request).value();
      EXPECT_TRUE(answer.solved && holds(arm.chain, request, answer.solutions[0])) << arm.name;
    }
  }
}

TEST_P(EveryMethod, SeveralSolutionsDifferAndTheNearestComesFirst) {
  for (const test_arms::Arm& arm : test_arms::unseen_arms()) {
    if (!arm.chain.plain()) continue;
    const auto sut = make(arm.chain);
    for (const JointValues& there : test_arms::random_postures(arm.chain, 3, 23)) {
      Request request = request_for(arm.chain, pose_at(arm.chain, there));
      request.max_solutions = 6;
      const Answer answer = sut->solve(request).value();
      ASSERT_TRUE(answer.solved) << arm.name;
      EXPECT_LE(answer.solutions.size(), 6U);
      EXPECT_GE(answer.solutions.size(), arm.chain.variable_count() > 6 ? 2U : 1U) << arm.name;
      for (std::size_t i = 0; i < answer.solutions.size(); ++i) {
        EXPECT_TRUE(holds(arm.chain, request, answer.solutions[i])) << arm.name;
        for (std::size_t k = 0; k < i; ++k) {
          EXPECT_GT(apart(arm.chain, answer.solutions[i].q, answer.solutions[k].q), 0.05) << arm.name;
        }
      }
    }
  }
}

TEST_P(EveryMethod, RefusesWhatIsNoRequestAndSaysWhy) {
  const test_arms::Arm arm = test_arms::random_arm(6, 1);
  const auto sut = make(arm.chain);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto what = [&](auto&& spoil) {
    Request request = request_for(arm.chain, Pose::Identity());
    spoil(request);
    const Result<Answer> answer = sut->solve(request);
    return answer ? std::string("accepted") : answer.error().what;
  };
  EXPECT_EQ(what([](Request& r) { r.X_BG.translation().x() = kNan; }), "the target has a number that is not finite");
  EXPECT_EQ(what([](Request& r) { r.X_BG.linear() *= 1.01; }), "the target's orientation is not a rotation");
  EXPECT_EQ(what([](Request& r) { r.X_BG.linear().col(0) *= -1.0; }), "the target's orientation is not a rotation");
  EXPECT_EQ(what([](Request& r) { r.X_BG.translation().y() = 1e9; }), "the target is farther away than 1000 km");
  EXPECT_EQ(what([](Request& r) { r.tolerance = 0; }), "the tolerance 0 is not positive");
  EXPECT_EQ(what([](Request& r) { r.tolerance = kNan; }), "the tolerance nan is not positive");
  EXPECT_EQ(what([](Request& r) { r.time_limit = microseconds(0); }), "the time limit 0 us is not positive");
  EXPECT_EQ(what([](Request& r) { r.present[2] = kNan; }), "the present value of joint j3 is not finite");
}

TEST_P(EveryMethod, PresentPostureBeyondTheLimitsIsClamped) {
  const test_arms::Arm arm = test_arms::random_arm(6, 1);
  const auto sut = make(arm.chain);
  Request request = request_for(arm.chain, pose_at(arm.chain, test_arms::random_postures(arm.chain, 1, 3)[0]));
  request.present.fill(50.0);
  const Answer answer = sut->solve(request).value();
  EXPECT_TRUE(answer.solved);
  EXPECT_TRUE(holds(arm.chain, request, answer.solutions[0]));
}

TEST_P(EveryMethod, TurnsAreTakenNearestToThePresentPosture) {
  const auto arms = test_arms::unseen_arms();
  const Chain& chain = arms[0].chain;  // limits of two turns each
  const auto sut = make(chain);
  JointValues there = {0.3, -1.0, 1.2, -0.5, 1.0, 0.4};
  Request request = request_for(chain, pose_at(chain, there));
  request.present = there;
  request.present[5] += 2 * std::numbers::pi - 0.7;
  const Answer answer = sut->solve(request).value();
  ASSERT_TRUE(answer.solved);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_LE(std::abs(answer.solutions[0].q[i] - request.present[i]), std::numbers::pi + 1e-6) << i;
  }
}

std::string name_of_case(const testing::TestParamInfo<Method>& info) { return std::string(name_of(info.param)); }

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod, testing::Values(Method::fast, Method::ipopt, Method::automatic),
                         name_of_case);

// Planar boom of equal links along x.
Chain boom(std::size_t links) {
  std::vector<kinematics::ChainJoint> joints(links);
  std::vector<kinematics::Variable> variables;
  for (std::size_t i = 0; i < links; ++i) {
    joints[i].variable = static_cast<std::uint8_t>(i);
    if (i > 0) joints[i].X_PJ = Pose(Eigen::Translation3d(1, 0, 0));
    variables.push_back({"q", JointKind::revolute, -1.6, 1.6});
  }
  return Chain::make(variables, joints, Pose(Eigen::Translation3d(1, 0, 0))).value();
}

TEST(AutomaticSolver, RedundantBoomMeetsPositionAndHeadingAndBendsEvenly) {
  const Chain chain = boom(5);
  const auto sut = make_solver(Method::automatic, chain, test_arms::kClock);
  Request request = request_for(
      chain, Pose(Eigen::Translation3d(4.0, 1.5, 0)) * Pose(Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitZ())));
  request.task = kinematics::task_of(InverseClass::edith, chain);
  const Answer answer = sut->solve(request).value();
  ASSERT_TRUE(answer.solved);
  EXPECT_LT(answer.solutions[0].error.norm(), 1e-4);
  double bend = 0;
  for (std::size_t i = 0; i < 5; ++i) bend += answer.solutions[0].q[i] * answer.solutions[0].q[i];
  // Any other posture of the same target bends more.
  Request several = request;
  several.max_solutions = 8;
  const Answer others = sut->solve(several).value();
  for (const Solution& other : others.solutions) {
    double more = 0;
    for (std::size_t i = 0; i < 5; ++i) more += other.q[i] * other.q[i];
    EXPECT_GE(more, bend - 1e-2);
  }
}

// The last n joints bend evenly, the others stay near to where they are.
TEST(AutomaticSolver, BoomClassesResolveTheSameTargetDifferently) {
  const Chain chain = boom(7);
  const auto sut = make_solver(Method::automatic, chain, test_arms::kClock);
  Request request = request_for(
      chain, Pose(Eigen::Translation3d(4.2, 2.6, 0)) * Pose(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ())));
  request.present = {1.0, -0.9, 0.8, -0.7, 0.6, -0.5, 0.4};
  std::vector<kinematics::Task> tasks;
  std::vector<JointValues> postures;
  for (const auto inverse_class :
       {InverseClass::boom_3, InverseClass::boom_4, InverseClass::boom_5, InverseClass::boom_6, InverseClass::edith}) {
    request.task = kinematics::task_of(inverse_class, chain);
    const Answer answer = sut->solve(request).value();
    ASSERT_TRUE(answer.solved);
    EXPECT_LT(answer.solutions[0].error.norm(), 1e-4) << "the heading too";
    const JointValues& q = answer.solutions[0].q;
    for (const JointValues& other : postures) {
      double difference = 0;
      for (std::size_t i = 0; i < 7; ++i) difference = std::max(difference, std::abs(q[i] - other[i]));
      EXPECT_GT(difference, 0.05);
    }
    postures.push_back(q);
    tasks.push_back(request.task);
  }
  // What a class makes small is smallest in its own posture.
  const auto objective = [&](const kinematics::Task& task, const JointValues& q) {
    double sum = 0;
    for (std::size_t i = 0; i < 7; ++i) {
      const double aim = kinematics::bends(chain, task, i) ? 0.0 : request.present[i];
      sum += (q[i] - aim) * (q[i] - aim);
    }
    return sum;
  };
  for (std::size_t own = 0; own < tasks.size(); ++own) {
    for (const JointValues& other : postures)
      EXPECT_LE(objective(tasks[own], postures[own]), objective(tasks[own], other) + 1e-2) << own;
  }
}

TEST(AutomaticSolver, FiveJointsAreToldWhichComponentsCannotBeMet) {
  const auto arms = test_arms::unseen_arms();
  const auto five = std::find_if(arms.begin(), arms.end(), [](const auto& arm) { return arm.name == "five-5"; });
  ASSERT_NE(five, arms.end());
  const Chain& chain = five->chain;
  const auto sut = make_solver(Method::automatic, chain, test_arms::kClock);
  const Pose X_there = pose_at(chain, {0.4, 0.8, -1.1, 0.6, 0.3});
  Request request = request_for(chain, X_there);
  EXPECT_TRUE(sut->solve(request).value().solved) << "a pose that the arm happens to reach";
  request.X_BG = X_there * Pose(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 1, 0).normalized()));
  const Answer refused = sut->solve(request).value();
  EXPECT_FALSE(refused.solved);
  EXPECT_GT(refused.solutions[0].error.norm(), 1e-2);
  request.task.orientation = OrientationTask::normal;
  EXPECT_TRUE(sut->solve(request).value().solved) << "a position and a direction take five joints";
}

TEST(AutomaticSolver, AnswersOfClosedFormsAreTheNearestOfAll) {
  const auto arms = test_arms::unseen_arms();
  const Chain& chain = arms[2].chain;  // PUMA 560
  const auto sut = make_solver(Method::automatic, chain, test_arms::kClock);
  const auto fast = make_solver(Method::fast, chain, test_arms::kClock);
  for (const JointValues& there : test_arms::random_postures(chain, 50, 41)) {
    Request request = request_for(chain, pose_at(chain, there));
    const Answer answer = sut->solve(request).value();
    ASSERT_TRUE(answer.solved);
    EXPECT_EQ(answer.solutions[0].by, FoundBy::closed_form);
    const double distance = apart(chain, answer.solutions[0].q, request.present);
    EXPECT_LE(distance, apart(chain, there, request.present) + 1e-6);
    request.max_solutions = 8;
    const Answer others = fast->solve(request).value();
    for (const Solution& other : others.solutions) {
      EXPECT_LE(distance, apart(chain, other.q, request.present) + 1e-3);
    }
  }
}

}  // namespace
}  // namespace cellmirror::inverse_kinematics
