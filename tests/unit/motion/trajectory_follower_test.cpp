// Trajectories over time: interpolation, replacing, stopping, tolerances, and what lags behind.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "rt_core/motion/trajectory_follower.hpp"
#include "rt_core/rt/allocation_guard.hpp"

namespace cellmirror::motion {
namespace {

constexpr double kDt = 0.001;
constexpr Nanoseconds kPeriod{1'000'000};

Trajectory trajectory_of(std::uint32_t id, std::vector<double> times, std::vector<KnotState> knots,
                         KnotOrder order = KnotOrder::positions) {
  Trajectory out;
  out.id = id;
  out.joints = 1;
  out.given = 1;
  out.max_velocity.fill(10);
  out.deceleration.fill(20);
  out.orders.assign(times.size(), order);
  out.times = std::move(times);
  out.knots = std::move(knots);
  return out;
}

// One joint at 1 kHz.
class TrajectoryFollowerTest : public testing::Test {
 protected:
  void SetUp() override { sut_.reset(1); }
  bool begin(const Trajectory& trajectory) { return sut_.begin(trajectory, std::span(&qd_, 1)); }
  bool tick() {
    now_ = now_ + kPeriod;
    const double before = q_;
    const double lower = lower_;
    const double upper = upper_;
    const bool moved =
        sut_.step(kDt, now_, {std::span(&lower, 1), std::span(&upper, 1)}, std::span(&q_, 1), std::span(&qd_, 1));
    if (!moved) qd_ = 0;
    EXPECT_LE(std::abs(q_ - before), sut_.fastest()[0] * kDt + 1e-12);
    return moved;
  }
  void ticks(int n) {
    for (int i = 0; i < n; ++i) tick();
  }
  [[nodiscard]] const TrajectoryState& state() const { return sut_.state(); }

  TrajectoryFollower sut_;
  Timestamp now_{1'000'000'000};
  double q_ = 0;
  double qd_ = 0;
  double lower_ = -3;
  double upper_ = 3;
};

TEST(Interpolation, MeetsTheStatesAtBothEnds) {
  const KnotState from{0.3, -0.7, 1.5};
  const KnotState to{1.1, 0.4, -2.5};
  for (const double duration : {0.01, 1.0, 7.0}) {
    for (const KnotOrder order : {KnotOrder::positions, KnotOrder::velocities, KnotOrder::accelerations}) {
      const KnotPair pair{order, duration};
      const KnotState first = interpolate(pair, from, to, 0);
      const KnotState last = interpolate(pair, from, to, duration);
      EXPECT_NEAR(first.position, from.position, 1e-9);
      EXPECT_NEAR(last.position, to.position, 1e-9);
      if (order == KnotOrder::positions) continue;
      EXPECT_NEAR(first.velocity, from.velocity, 1e-7);
      EXPECT_NEAR(last.velocity, to.velocity, 1e-7);
      if (order == KnotOrder::velocities) continue;
      EXPECT_NEAR(first.acceleration, from.acceleration, 1e-4);
      EXPECT_NEAR(last.acceleration, to.acceleration, 1e-4);
    }
  }
}

// Of x(t) = t^5: nothing else of degree 5 has these ends.
TEST(Interpolation, OfDegreeFiveIsExactForPolynomialsOfDegreeFive) {
  const auto at = [](double t) { return KnotState{std::pow(t, 5), 5 * std::pow(t, 4), 20 * std::pow(t, 3)}; };
  const KnotPair pair{KnotOrder::accelerations, 1.5};
  for (const double t : {0.0, 0.4, 1.0, 1.5}) {
    const KnotState is = interpolate(pair, at(0.5), at(2.0), t);
    EXPECT_NEAR(is.position, at(0.5 + t).position, 1e-9);
    EXPECT_NEAR(is.velocity, at(0.5 + t).velocity, 1e-9);
    EXPECT_NEAR(is.acceleration, at(0.5 + t).acceleration, 1e-8);
  }
}

TEST_F(TrajectoryFollowerTest, GoesOnStraightLinesBetweenPositions) {
  const Trajectory one = trajectory_of(1, {0.0, 0.1, 0.2}, {{0}, {0.5}, {0.2}});
  ASSERT_TRUE(begin(one));
  tick();  // takes it: time 0
  ticks(50);
  EXPECT_NEAR(q_, 0.25, 1e-9);
  EXPECT_NEAR(qd_, 5, 1e-6);
  ticks(100);
  EXPECT_NEAR(q_, 0.35, 1e-9);
  EXPECT_TRUE(state().moving);
  ticks(60);
  EXPECT_EQ(q_, 0.2);
  EXPECT_FALSE(state().moving);
  EXPECT_EQ(state().finished, 1U);
  EXPECT_EQ(state().outcome, TrajectoryOutcome::arrived);
  EXPECT_EQ(sut_.running(), nullptr);
}

TEST_F(TrajectoryFollowerTest, GoesFromWhereTheRobotStandsToTheFirstPoint) {
  q_ = 0.4;
  const Trajectory one = trajectory_of(1, {0.1}, {{0.5, 0, 0}}, KnotOrder::velocities);
  ASSERT_TRUE(begin(one));
  ticks(51);
  EXPECT_NEAR(q_, 0.45, 2e-3);
  EXPECT_GT(qd_, 1);
  ticks(60);
  EXPECT_NEAR(q_, 0.5, 1e-12);
}

TEST_F(TrajectoryFollowerTest, ANewTrajectoryReplacesTheRunningOneWithoutAJerk) {
  const Trajectory one = trajectory_of(1, {1.0}, {{2.0, 0, 0}}, KnotOrder::velocities);
  const Trajectory two = trajectory_of(2, {0.5}, {{0.0, 0, 0}}, KnotOrder::velocities);
  ASSERT_TRUE(begin(one));
  ticks(500);
  const double before = qd_;
  EXPECT_NEAR(before, 3.0, 0.05);
  ASSERT_TRUE(begin(two));
  EXPECT_EQ(state().finished, 1U);
  EXPECT_EQ(state().outcome, TrajectoryOutcome::superseded);
  tick();
  EXPECT_NEAR(qd_, before, 0.1);
  ticks(600);
  EXPECT_NEAR(q_, 0, 1e-12);
  EXPECT_EQ(state().finished, 2U);
  EXPECT_FALSE(begin(one)) << "ids ascend";
}

TEST_F(TrajectoryFollowerTest, LeavesOutPointsWhoseTimeHasPassed) {
  q_ = 1;
  Trajectory one = trajectory_of(1, {0.0, 0.1, 0.2}, {{-1}, {-1}, {1.1}});
  one.start = now_ - Nanoseconds(150'000'000);
  ASSERT_TRUE(begin(one));
  ticks(20);
  EXPECT_GT(q_, 1) << "it never turns back to a point of the past";
  ticks(60);
  EXPECT_NEAR(q_, 1.1, 1e-12);
}

TEST_F(TrajectoryFollowerTest, WaitsForAStartThatHasNotCome) {
  Trajectory one = trajectory_of(1, {0.0, 0.1}, {{0}, {0.5}});
  one.start = now_ + Nanoseconds(100'000'000);
  ASSERT_TRUE(begin(one));
  ticks(99);
  EXPECT_NEAR(q_, 0, 1e-12);
  EXPECT_LT(state().elapsed, 0);
  ticks(105);
  EXPECT_EQ(q_, 0.5);
}

TEST_F(TrajectoryFollowerTest, StopBrakesAndEndsAtRest) {
  const Trajectory one = trajectory_of(1, {1.0}, {{2.0}});
  ASSERT_TRUE(begin(one));
  ticks(500);
  EXPECT_NEAR(qd_, 2, 0.01);
  const double from = q_;
  sut_.stop(TrajectoryOutcome::stopped);
  EXPECT_EQ(state().finished, 0U);
  ticks(150);
  EXPECT_NEAR(q_ - from, 2.0 * 2.0 / (2 * 20), 0.005);  // v^2 / 2a
  EXPECT_FALSE(state().moving);
  EXPECT_EQ(state().finished, 1U);
  EXPECT_EQ(state().outcome, TrajectoryOutcome::stopped);
}

TEST_F(TrajectoryFollowerTest, AJointThatIsTooSlowLagsBehindAndComesToTheEnd) {
  Trajectory one = trajectory_of(1, {0.1}, {{1.0}});
  one.max_velocity.fill(2);
  ASSERT_TRUE(begin(one));
  ticks(101);
  EXPECT_NEAR(q_, 0.2, 0.01);
  EXPECT_NEAR(state().reference[0].position, 1.0, 1e-9);
  EXPECT_TRUE(state().moving);
  ticks(450);
  EXPECT_EQ(q_, 1.0);
  EXPECT_FALSE(state().moving);
}

TEST_F(TrajectoryFollowerTest, ADeviationBeyondThePathToleranceEndsIt) {
  Trajectory one = trajectory_of(1, {0.1, 0.5}, {{1.0}, {1.5}});
  one.max_velocity.fill(2);
  one.path_tolerance[0] = 0.1;
  ASSERT_TRUE(begin(one));
  for (int i = 0; i < 500 && state().finished == 0; ++i) tick();
  EXPECT_EQ(state().outcome, TrajectoryOutcome::path_tolerance);
  EXPECT_EQ(state().joint, 0);
  EXPECT_GT(state().deviation, 0.1);
  EXPECT_LT(q_, 0.5);
  EXPECT_EQ(qd_, 0);
}

TEST_F(TrajectoryFollowerTest, AGoalThatIsNotMetInTimeEndsIt) {
  Trajectory one = trajectory_of(1, {0.1}, {{1.0}});
  one.max_velocity.fill(1);
  one.goal_tolerance[0] = 0.05;
  one.goal_time = 0.2;
  ASSERT_TRUE(begin(one));
  ticks(290);
  EXPECT_EQ(state().finished, 0U) << "it has still time";
  for (int i = 0; i < 500 && state().finished == 0; ++i) tick();
  EXPECT_EQ(state().outcome, TrajectoryOutcome::goal_tolerance);
}

TEST_F(TrajectoryFollowerTest, ALateGoalIsMetWithinItsTime) {
  Trajectory one = trajectory_of(1, {0.1}, {{0.5}});
  one.max_velocity.fill(1);
  one.goal_tolerance[0] = 0.05;
  one.goal_time = 5;
  ASSERT_TRUE(begin(one));
  ticks(200);
  EXPECT_EQ(state().finished, 0U);
  ticks(400);
  EXPECT_EQ(state().outcome, TrajectoryOutcome::arrived);
  EXPECT_EQ(q_, 0.5);
}

TEST_F(TrajectoryFollowerTest, NeverLeavesTheRange) {
  upper_ = 0.3;
  const Trajectory one = trajectory_of(1, {0.1, 0.2}, {{1.0}, {0.0}});
  ASSERT_TRUE(begin(one));
  for (int i = 0; i < 300; ++i) {
    tick();
    EXPECT_LE(q_, 0.3);
  }
  EXPECT_FALSE(state().moving);
}

TEST_F(TrajectoryFollowerTest, JointsThatAreNotGivenStay) {
  sut_.reset(2);
  Trajectory one = trajectory_of(1, {0.1}, {{1.0}, {9.0}});
  one.joints = 2;
  std::array<double, 2> q{0, 0.7};
  std::array<double, 2> qd{};
  const std::array<double, 2> lower{-3, -3};
  const std::array<double, 2> upper{3, 3};
  ASSERT_TRUE(sut_.begin(one, qd));
  for (int i = 0; i < 300; ++i) {
    now_ = now_ + kPeriod;
    sut_.step(kDt, now_, {lower, upper}, q, qd);
  }
  EXPECT_EQ(q[0], 1.0);
  EXPECT_EQ(q[1], 0.7);
}

TEST_F(TrajectoryFollowerTest, RefusesWhatIsNotSound) {
  EXPECT_FALSE(begin(trajectory_of(0, {0.1}, {{1}})));
  EXPECT_FALSE(begin(trajectory_of(1, {}, {})));
  EXPECT_FALSE(begin(trajectory_of(1, {0.1, 0.1}, {{1}, {1}})));
  EXPECT_FALSE(begin(trajectory_of(1, {0.2, 0.1}, {{1}, {1}})));
  EXPECT_FALSE(begin(trajectory_of(1, {0.1}, {{std::nan("")}})));
  EXPECT_FALSE(begin(trajectory_of(1, {0.1}, {{1}, {1}})));
  EXPECT_FALSE(sut_.active());
}

TEST_F(TrajectoryFollowerTest, AllocatesNothing) {
  ASSERT_TRUE(AllocationGuard::armed());
  const Trajectory one = trajectory_of(1, {0.1, 0.2}, {{0.1}, {0.2}});
  const AllocationGuard guard;
  EXPECT_TRUE(begin(one));
  ticks(300);
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cellmirror::motion
