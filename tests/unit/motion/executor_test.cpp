#include "rt_core/motion/executor.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "arms.hpp"
#include "ride.hpp"
#include "rt_core/rt/allocation_guard.hpp"

namespace cellmirror::motion {
namespace {

using test_arms::puma;
using test_arms::puma_posture;

JointValues random_posture(const kinematics::Chain& chain, std::mt19937_64& random) {
  JointValues q{};
  for (std::size_t i = 0; i < chain.variable_count(); ++i)
    q[i] = std::uniform_real_distribution(chain.lower()[i], chain.upper()[i])(random);
  return q;
}

// When each joint came to rest, in seconds from the start.
std::array<double, 6> rest_times(Ride& ride) {
  std::array<double, 6> times{};
  const double start = ride.now();
  JointValues before = ride.q();
  ride.run([&] {
    for (std::size_t i = 0; i < 6; ++i) {
      if (ride.q()[i] != before[i]) times[i] = ride.now() - start;
    }
    before = ride.q();
  });
  return times;
}

TEST(JointMove, SynchronousAxesEndTogetherWithTheSlowest) {
  Ride ride(puma(), puma_posture());
  const JointValues target = {1.2, -1.0, 0.7, 0.3, 1.0, 1.6};
  const Move move = ride.joints_to(target);
  const double seconds = duration_of(move, ride.q(), 6);
  EXPECT_NEAR(seconds, 2.0 / 1.0 + 0.25, 1e-12);
  ASSERT_TRUE(ride.sut().add(move));
  const auto times = rest_times(ride);
  for (const std::size_t i : {0U, 1U, 2U, 4U, 5U}) EXPECT_NEAR(times[i], seconds, 0.003) << i;
  EXPECT_EQ(times[3], 0.0);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(ride.q()[i], target[i], 1e-12);
}

TEST(JointMove, AsynchronousAxesEndAtTheirOwnTimes) {
  Ride ride(puma(), puma_posture());
  ride.parameters.ptp_mode = PtpMode::asynchronous;
  const JointValues start = ride.q();
  const JointValues target = {1.2, -1.0, 0.7, 0.3, 1.0, 1.6};
  ASSERT_TRUE(ride.sut().add(ride.joints_to(target)));
  const auto times = rest_times(ride);
  for (std::size_t i = 0; i < 6; ++i) {
    const double way = std::abs(target[i] - start[i]);
    // v = 1, a = 4: a triangle below 250 mrad.
    const double seconds = way < 0.25 ? 2 * std::sqrt(way / 4) : way + 0.25;
    EXPECT_NEAR(times[i], way == 0 ? 0 : seconds, 0.003) << i;
  }
}

TEST(JointMove, AccelerationFromRestIsBoundedByHalfPiTimesItsValueForSinesAndByItselfForRamps) {
  std::mt19937_64 random(3);
  for (const VelocityProfile profile : {VelocityProfile::sine, VelocityProfile::ramp}) {
    const double bound = 4.0 * (profile == VelocityProfile::sine ? std::numbers::pi / 2 : 1.0);
    for (int round = 0; round < 100; ++round) {
      Ride ride(puma(), puma_posture());
      ride.parameters.velocity_profile = profile;
      ride.parameters.ptp_mode = round % 2 == 0 ? PtpMode::synchronous : PtpMode::asynchronous;
      ASSERT_TRUE(ride.sut().add(ride.joints_to(random_posture(ride.chain(), random))));
      JointValues before{};
      ride.run([&] {
        for (std::size_t i = 0; i < 6; ++i)
          ASSERT_LE(std::abs(ride.qd()[i] - before[i]), bound * Ride::kTick * (1 + 1e-6) + 1e-9);
        before = ride.qd();
      });
    }
  }
}

TEST(JointMove, NewTargetIsTakenUpAtOnceFromPositionAndVelocity) {
  Ride ride(puma(), puma_posture());
  JointValues target = ride.q();
  target[0] += 1.0;
  ASSERT_TRUE(ride.sut().add(ride.joints_to(target)));
  while (ride.now() < 0.5) ride.tick();
  EXPECT_NEAR(ride.qd()[0], 1.0, 1e-9);
  target[0] += 0.5;
  ASSERT_TRUE(ride.sut().add(ride.joints_to(target)));
  EXPECT_EQ(ride.state().finished, 1U);
  EXPECT_EQ(ride.state().outcome, Outcome::superseded);
  for (int i = 0; i < 100; ++i) {
    ride.tick();
    EXPECT_NEAR(ride.qd()[0], 1.0, 1e-9);
  }
  ride.run();
  EXPECT_NEAR(ride.q()[0], target[0], 1e-12);
  EXPECT_NEAR(ride.now(), 1.75, 0.005);
}

TEST(JointMove, StopAtAnyTimeStaysWithinTheRange) {
  for (int when = 1; when < 2200; when += 37) {
    Ride ride(puma(), puma_posture());
    JointValues target = ride.q();
    target[1] = ride.chain().upper()[1];
    target[0] = ride.chain().lower()[0];
    ASSERT_TRUE(ride.sut().add(ride.joints_to(target)));
    for (int i = 0; i < when; ++i) ride.tick();
    ride.sut().stop();
    EXPECT_LE(ride.run(), 0.26);
    EXPECT_EQ(ride.state().outcome, Outcome::stopped);
  }
}

TEST(MoveQueue, RunsInOrderWithPausesAndTellsWhatIsUnderWay) {
  Ride ride(puma(), puma_posture());
  JointValues a = ride.q();
  a[0] += 0.1;
  JointValues b = a;
  b[1] -= 0.1;
  ASSERT_TRUE(ride.sut().add(ride.joints_to(a, Start::queue)));
  ASSERT_TRUE(ride.sut().add(ride.pause(0.2)));
  ASSERT_TRUE(ride.sut().add(ride.joints_to(b, Start::queue)));
  std::vector<std::uint32_t> order;
  const double seconds = ride.run([&] {
    const std::uint32_t running = ride.state().running;
    if (running != 0 && (order.empty() || order.back() != running)) order.push_back(running);
    EXPECT_LE(ride.state().finished, 3U);
  });
  EXPECT_EQ(order, (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_NEAR(seconds, 2 * 2 * std::sqrt(0.1 / 4) + 0.2, 0.005);
  EXPECT_EQ(ride.state().finished, 3U);
  EXPECT_EQ(ride.state().waiting, 0);
  EXPECT_NEAR(ride.q()[1], b[1], 1e-12);
}

TEST(MoveQueue, RefusesWhatIsTooManyAndTellsItWhenTheRestHasEnded) {
  Ride ride(puma(), puma_posture());
  for (std::size_t i = 0; i < kMoveQueue; ++i) ASSERT_TRUE(ride.sut().add(ride.pause(0.001)));
  EXPECT_EQ(ride.state().waiting, kMoveQueue);
  EXPECT_FALSE(ride.sut().add(ride.pause(0.001)));
  ride.run();
  EXPECT_EQ(ride.state().finished, kMoveQueue + 1);
  EXPECT_EQ(ride.state().finished_from, kMoveQueue + 1);
  EXPECT_EQ(ride.state().outcome, Outcome::blocked);
}

TEST(MoveQueue, ThatIsFullTakesASupersedingMove) {
  Ride ride(puma(), puma_posture());
  for (std::size_t i = 0; i < kMoveQueue; ++i) ASSERT_TRUE(ride.sut().add(ride.pause(1)));
  JointValues target = ride.q();
  target[0] += 0.1;
  ASSERT_TRUE(ride.sut().add(ride.joints_to(target)));
  EXPECT_LT(ride.run(), 1.0);
  EXPECT_NEAR(ride.q()[0], target[0], 1e-12);
  EXPECT_EQ(ride.state().outcome, Outcome::arrived);
}

TEST(JointMove, BeyondARangeThatWasNarrowedMeanwhileIsBlocked) {
  for (const double side : {1.0, -1.0}) {
    MoveExecutor sut;
    sut.reset(2);
    Move move;
    move.id = 1;
    move.target = {0.0, side};
    move.velocity.fill(1.0);
    move.max_velocity.fill(2.0);
    move.acceleration.fill(4.0);
    ASSERT_TRUE(sut.add(move));
    JointValues q{};
    JointValues qd{};
    const JointValues lower = {-2.0, -0.5};
    const JointValues upper = {2.0, 0.5};
    for (int i = 0; i < 5; ++i)
      sut.step(1e-3, Timestamp{i + 1}, {std::span(lower).first(2), std::span(upper).first(2)}, std::span(q).first(2),
               std::span(qd).first(2));
    EXPECT_EQ(q, JointValues{}) << side;
    EXPECT_EQ(sut.state().outcome, Outcome::blocked) << side;
    EXPECT_FALSE(sut.state().moving) << side;
  }
}

// Otherwise the gate, which checks each step against fastest(), would end the move where it stands.
TEST(JointMove, SlowerOneInThePlaceOfAFasterOneIsAllowedItsSpeedUntilItHasBraked) {
  Ride ride(puma(), puma_posture());
  JointValues target = ride.q();
  target[0] += 2.0;
  ASSERT_TRUE(ride.sut().add(ride.joints_to(target)));
  for (int i = 0; i < 500; ++i) ride.tick();
  ASSERT_NEAR(ride.qd()[0], 1.0, 1e-9);
  Move slow = ride.joints_to(target);
  slow.velocity[0] = slow.max_velocity[0] = 0.25;
  ASSERT_TRUE(ride.sut().add(slow));
  ride.tick();
  EXPECT_GE(ride.sut().fastest()[0], std::abs(ride.qd()[0]));
  EXPECT_NEAR(ride.qd()[0], 1.0, 0.01);
  ride.run();
  EXPECT_NEAR(ride.q()[0], target[0], 1e-12);
  EXPECT_EQ(ride.state().outcome, Outcome::arrived);
}

TEST(PtpMotion, BrakingTogetherTakesTheTimeOfTheSlowestAndNoAxisBrakesHarderThanItMay) {
  const JointValues q{};
  const JointValues wide_low = {-10, -10, -10};
  const JointValues wide_high = {10, 10, 10};
  const JointRange range{std::span(wide_low).first(3), std::span(wide_high).first(3)};
  for (const JointValues& qd : {JointValues{1.0, 0.1, -0.5}, JointValues{0.1, -1.0, 0.5}}) {
    const JointValues acceleration = {4.0, 2.0, 1.0};
    PtpMotion sut;
    sut.brake_together(acceleration, std::span(q).first(3), std::span(qd).first(3), range);
    EXPECT_NEAR(sut.duration(), 0.5, 1e-12);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LE(std::abs(sut.axis(i).at(0.0).acceleration), acceleration[i] * (1 + 1e-9)) << i;
      EXPECT_NEAR(sut.axis(i).duration(), 0.5, 1e-9) << i;
    }
  }
}

TEST(MoveQueue, SupersedingMoveForgetsWhatWaits) {
  Ride ride(puma(), puma_posture());
  JointValues target = ride.q();
  target[0] += 1;
  ASSERT_TRUE(ride.sut().add(ride.joints_to(target)));
  ASSERT_TRUE(ride.sut().add(ride.pause(5)));
  ride.tick();
  ASSERT_TRUE(ride.sut().add(ride.joints_to(puma_posture())));
  EXPECT_EQ(ride.state().finished, 2U);
  EXPECT_EQ(ride.state().finished_from, 1U);
  EXPECT_EQ(ride.state().outcome, Outcome::superseded);
  EXPECT_EQ(ride.state().running, 3U);
  EXPECT_LT(ride.run(), 1.0);
  EXPECT_EQ(ride.state().finished, 3U);
}

TEST(MoveQueue, StopEndsEverythingThatWasGivenBeforeIt) {
  Ride ride(puma(), puma_posture());
  JointValues target = ride.q();
  target[0] += 1;
  ASSERT_TRUE(ride.sut().add(ride.joints_to(target)));
  ASSERT_TRUE(ride.sut().add(ride.pause(5)));
  while (ride.now() < 0.5) ride.tick();
  ride.sut().stop();
  ASSERT_TRUE(ride.sut().add(ride.joints_to(puma_posture(), Start::queue)));
  while (ride.state().finished == 0) ride.tick();
  EXPECT_EQ(ride.state().finished, 2U);
  EXPECT_EQ(ride.state().finished_from, 1U);
  EXPECT_EQ(ride.state().outcome, Outcome::stopped);
  EXPECT_NEAR(ride.now(), 0.75, 0.003);
  ride.run();
  EXPECT_EQ(ride.state().finished, 3U);
  EXPECT_EQ(ride.state().outcome, Outcome::arrived);
  EXPECT_NEAR(ride.q()[0], puma_posture()[0], 1e-12);
}

TEST(MoveQueue, AbortStandsAtOnce) {
  Ride ride(puma(), puma_posture());
  JointValues target = ride.q();
  target[0] += 1;
  ASSERT_TRUE(ride.sut().add(ride.joints_to(target)));
  while (ride.now() < 0.5) ride.tick();
  ride.sut().abort(Outcome::stopped);
  const JointValues where = ride.q();
  EXPECT_FALSE(ride.tick());
  EXPECT_EQ(ride.q(), where);
  EXPECT_FALSE(ride.state().moving);
}

TEST(MoveQueue, StopWhereNothingRunsDoesNothing) {
  Ride ride(puma(), puma_posture());
  ride.sut().stop();
  EXPECT_FALSE(ride.tick());
  EXPECT_EQ(ride.state().finished, 0U);
}

TEST(Move, EverythingThatIsNoNumberOrNotPositiveIsRefused) {
  Ride ride(puma(), puma_posture());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Move joints = ride.joints_to(puma_posture());
  const Move line = *ride.line_to(ride.q(), ride.X_BT());
  ASSERT_TRUE(is_sound(joints, 6));
  ASSERT_TRUE(is_sound(line, 6));
  const auto refused = [&](Move move, auto change) {
    change(move);
    return !is_sound(move, 6);
  };
  for (const double bad : {nan, std::numeric_limits<double>::infinity(), -1.0, 0.0}) {
    EXPECT_TRUE(refused(joints, [&](Move& m) { m.velocity[5] = bad; }));
    EXPECT_TRUE(refused(joints, [&](Move& m) { m.acceleration[0] = bad; }));
    EXPECT_TRUE(refused(joints, [&](Move& m) { m.max_velocity[2] = bad; }));
    EXPECT_TRUE(refused(line, [&](Move& m) { m.max_velocity[2] = bad; }));
    EXPECT_TRUE(refused(line, [&](Move& m) { m.linear_velocity = bad; }));
    EXPECT_TRUE(refused(line, [&](Move& m) { m.linear_acceleration = bad; }));
    EXPECT_TRUE(refused(line, [&](Move& m) { m.rotational_velocity = bad; }));
    EXPECT_TRUE(refused(line, [&](Move& m) { m.rotational_acceleration = bad; }));
  }
  EXPECT_TRUE(refused(joints, [&](Move& m) { m.target[3] = nan; }));
  EXPECT_TRUE(refused(line, [&](Move& m) { m.X_BG.translation().x() = nan; }));
  EXPECT_TRUE(refused(line, [&](Move& m) { m.X_BG.linear() *= 1.1; }));
  EXPECT_TRUE(refused(line, [&](Move& m) { m.X_BG.linear().col(0) *= -1.0; })) << "a reflection";
  EXPECT_TRUE(refused(line, [&](Move& m) { m.fly_parameter = nan; }));
  EXPECT_TRUE(refused(line, [&](Move& m) { m.min_velocity[1] = nan; }));
  EXPECT_TRUE(refused(ride.pause(1), [&](Move& m) { m.delay_s = nan; }));
  Move seventh = joints;
  seventh.target[6] = nan;  // there is no such joint
  EXPECT_TRUE(is_sound(seventh, 6));
}

TEST(Move, LineWithoutAChainIsRefused) {
  Ride ride(puma(), puma_posture());
  const Move line = *ride.line_to(ride.q(), ride.X_BT());
  ride.sut().set_chain(nullptr);
  EXPECT_FALSE(ride.sut().add(line));
  ride.run();
  EXPECT_EQ(ride.state().outcome, Outcome::blocked);
}

// Random moves of all kinds, superseded, queued, late, held and stopped at random: Ride checks ranges and velocities in
// every tick. Then a last move that arrives exactly.
class RandomMoves : public testing::TestWithParam<int> {};

TEST_P(RandomMoves, KeepRangesAndVelocitiesInEveryTickAndArrive) {
  const bool seven = GetParam() % 2 != 0;
  std::mt19937_64 random(static_cast<std::uint64_t>(GetParam()));
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  Ride ride(seven ? test_arms::panda() : puma(), seven ? test_arms::panda_posture() : puma_posture());
  const std::size_t n = ride.joints();
  int lines = 0;
  for (int round = 0; round < 60; ++round) {
    RobotParameters& p = ride.parameters;
    p.velocity_profile = random() % 2 == 0 ? VelocityProfile::sine : VelocityProfile::ramp;
    p.ptp_mode = random() % 2 == 0 ? PtpMode::synchronous : PtpMode::asynchronous;
    for (std::size_t i = 0; i < n; ++i) {
      p.active_velocity[i] = uniform(0.3, 2.5);
      p.active_acceleration[i] = uniform(1, 9);
    }
    p.linear_velocity = uniform(0.05, 1.5);
    p.linear_acceleration = uniform(0.5, 10);
    p.fly_type = static_cast<FlyType>(random() % 3);
    p.fly_parameter = uniform(0, 0.3);
    const Start start = random() % 2 == 0 ? Start::supersede : Start::queue;
    const auto give = [&](Move move) {
      if (random() % 3 == 0) move.begin = Ride::time_of(ride.now() - uniform(-0.01, 0.1));
      move.follows_on = random() % 2 == 0;
      move.fly_parameter = p.fly_parameter;
      move.fly_type = p.fly_type;
      ASSERT_TRUE(ride.sut().add(move));
    };
    if (random() % 2 == 0) {
      give(ride.joints_to(random_posture(ride.chain(), random), start));
    } else {
      Pose to = ride.X_BT();
      to.translation() += Eigen::Vector3d(uniform(-0.2, 0.2), uniform(-0.2, 0.2), uniform(-0.2, 0.2));
      to.linear() = Eigen::AngleAxisd(uniform(-1, 1), Eigen::Vector3d(uniform(-1, 1), uniform(-1, 1), 1).normalized()) *
                    to.linear();
      const Eigen::Vector3d via =
          ride.X_BT().translation() + Eigen::Vector3d(uniform(-0.2, 0.2), uniform(-0.2, 0.2), 0);
      const auto move = random() % 3 == 0 ? ride.arc_to(ride.q(), via, to, start) : ride.line_to(ride.q(), to, start);
      if (move) {
        give(*move);
        ++lines;
      }
    }
    if (random() % 4 == 0) ride.sut().set_pace(random() % 2 == 0 ? 1 : uniform(-0.3, 1));
    if (random() % 8 == 0) ride.sut().hold_behind(random() % 2 == 0 ? 0 : ride.state().running);
    if (random() % 10 == 0) ride.sut().stop();
    const double ticks = uniform(0, 800);
    for (int i = 0; i < ticks; ++i) ride.tick(random() % 50 == 0 ? 0.01 : Ride::kTick);
    ASSERT_FALSE(testing::Test::HasFailure()) << "round " << round;
  }
  ride.sut().set_pace(1);
  ride.sut().hold_behind(0);
  ride.run();
  const JointValues target = random_posture(ride.chain(), random);
  ASSERT_TRUE(ride.sut().add(ride.joints_to(target)));
  ride.run();
  for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(ride.q()[i], target[i], 1e-9);
  EXPECT_EQ(ride.state().outcome, Outcome::arrived);
  EXPECT_GT(lines, 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomMoves, testing::Range(1, 61));

TEST(MoveExecutor, LeavesTheHeapAlone) {
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  Ride ride(puma(), puma_posture());
  ride.parameters.fly_parameter = 0.05;
  std::vector<Move> moves;
  Pose to = ride.X_BT();
  for (int i = 0; i < 8; ++i) {
    to.translation().y() -= 0.05;
    moves.push_back(*ride.line_to(ride.q(), to, i % 4 == 3 ? Start::supersede : Start::queue));
    moves.push_back(i % 4 == 2 ? ride.joints_to(puma_posture(), Start::queue) : ride.pause(0.01));
  }
  moves.push_back(*ride.arc_to(ride.q(), ride.X_BT().translation() + Eigen::Vector3d(0.05, -0.05, 0), to));
  JointValues q = ride.q();
  JointValues qd{};
  const JointRange range{ride.chain().lower(), ride.chain().upper()};
  const AllocationGuard guard;
  for (const Move& move : moves) {
    ride.sut().add(move);
    for (int i = 0; i < 100; ++i)
      ride.sut().step(1e-3, ride.time(), range, std::span(q).first(6), std::span(qd).first(6));
  }
  for (const double pace : {0.0, 0.5, 1.0}) {
    ride.sut().set_pace(pace);
    for (int i = 0; i < 100; ++i)
      ride.sut().step(1e-3, ride.time(), range, std::span(q).first(6), std::span(qd).first(6));
  }
  ride.sut().stop();
  for (int i = 0; i < 1000; ++i)
    ride.sut().step(1e-3, ride.time(), range, std::span(q).first(6), std::span(qd).first(6));
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(guard.frees(), 0U);
}

}  // namespace
}  // namespace cellmirror::motion
