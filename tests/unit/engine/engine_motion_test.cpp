// Robots that are moved by the tick.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "arms.hpp"

#include "rt_core/engine/engine.hpp"
#include "rt_core/engine/limiter.hpp"
#include "rt_core/motion/planner.hpp"
#include "rt_core/rt/allocation_guard.hpp"
#include "tests/unit/engine/commands.hpp"

namespace cellmirror::engine {
namespace {

constexpr std::uint8_t kSlot = 3;
constexpr std::uint8_t kJoints = 2;

class EngineMotionTest : public testing::Test {
 protected:
  EngineMotionTest() {
    send_robot(*sut_, kSlot, robot_of(kJoints, -1.0, 1.0, {0.1, 0.2}));
    tick();
  }

  void tick(std::uint64_t missed = 0) {
    now_ = now_ + kPeriod * static_cast<std::int64_t>(1 + missed);
    run_cycle(*sut_, now_, cycle_, missed);
  }

  // Cruises at 0.5, a quarter of a second to get there.
  static motion::Move to(double a, double b, std::uint32_t id) {
    motion::Move move;
    move.id = id;
    move.target = {a, b};
    move.velocity = {0.5, 0.5};
    move.max_velocity = {0.5, 0.5};
    move.acceleration = {2.0, 2.0};
    return move;
  }

  const RobotTickState& robot() { return ticks_.newest().robots[kSlot]; }

  // Ticks until the robot stands; how many it took.
  int run_until_it_stands(int most = 20'000) {
    int ticks = 0;
    while (ticks < most && (ticks == 0 || robot().motion.moving)) {
      tick();
      ++ticks;
    }
    return ticks;
  }

  Watchdog watchdog_{std::chrono::milliseconds(100), {}};
  std::unique_ptr<Engine> sut_ = std::make_unique<Engine>(watchdog_);
  TickReader& ticks_ = sut_->subscribe("test");
  Timestamp now_{1'000'000'000};
  std::uint64_t cycle_ = 0;
};

TEST_F(EngineMotionTest, MoveArrivesAtItsTargetInItsTimeAndTellsItsId) {
  ASSERT_NE(send_move(*sut_, kSlot, to(0.9, -0.8, 1)), 0U);
  const int ticks = run_until_it_stands();
  EXPECT_NEAR(ticks, (1.0 / 0.5 + 0.25) * 1000, 1.5);  // the second joint goes furthest
  EXPECT_NEAR(robot().joints[0].position, 0.9, 1e-12);
  EXPECT_NEAR(robot().joints[1].position, -0.8, 1e-12);
  EXPECT_EQ(robot().joints[1].velocity, 0.0);
  EXPECT_EQ(robot().motion.finished, 1U);
  EXPECT_EQ(robot().motion.outcome, motion::Outcome::arrived);
  EXPECT_EQ(robot().motion.running, 0U);
}

TEST_F(EngineMotionTest, VelocitiesArePublishedWhileItMoves) {
  send_move(*sut_, kSlot, to(0.9, -0.8, 1));
  for (int i = 0; i < 1000; ++i) tick();
  EXPECT_TRUE(robot().motion.moving);
  EXPECT_EQ(robot().motion.running, 1U);
  EXPECT_NEAR(robot().joints[1].velocity, -0.5, 1e-12);
}

TEST_F(EngineMotionTest, PositionsAndMovesAreCarriedOutInTheOrderInWhichTheyWereSent) {
  sut_->send(SetPositions{.slot = kSlot, .positions = {0.0, 0.0}});
  send_move(*sut_, kSlot, to(0.5, 0.5, 1));
  tick();
  EXPECT_TRUE(robot().motion.moving);
  send_move(*sut_, kSlot, to(0.9, 0.9, 2));
  sut_->send(SetPositions{.slot = kSlot, .positions = {-0.5, -0.5}});
  tick();
  EXPECT_FALSE(robot().motion.moving);
  EXPECT_EQ(robot().joints[0].position, -0.5);
  EXPECT_EQ(robot().joints[0].velocity, 0.0);
  EXPECT_EQ(robot().motion.finished, 2U);
  EXPECT_EQ(robot().motion.finished_from, 2U);
  EXPECT_EQ(robot().motion.outcome, motion::Outcome::stopped);
}

TEST_F(EngineMotionTest, RobotThatGoesOnlineStopsAtOnceAndTakesNoMoves) {
  send_move(*sut_, kSlot, to(0.9, 0.9, 1));
  for (int i = 0; i < 500; ++i) tick();
  const double where = robot().joints[0].position;
  sut_->send(SetMode{.slot = kSlot,
                     .mode = RobotMode::mirrored,
                     .ages = {std::chrono::milliseconds(10), std::chrono::milliseconds(50)}});
  tick();
  EXPECT_EQ(robot().joints[0].position, where);
  EXPECT_FALSE(robot().motion.moving);
  EXPECT_EQ(robot().motion.finished, 1U);
  send_move(*sut_, kSlot, to(0.9, 0.9, 2));
  sut_->send(SetChain{.slot = kSlot});
  sut_->send(StopMotion{kSlot});
  sut_->send(SetPace{.slot = kSlot, .pace = 0});
  sut_->send(HoldBehind{.slot = kSlot, .move = 1});
  tick();
  EXPECT_EQ(ticks_.newest().commands_refused, 5U);
  EXPECT_EQ(robot().joints[0].position, where);
}

TEST_F(EngineMotionTest, StopBrakesWithinTheAcceleration) {
  send_move(*sut_, kSlot, to(0.9, 0.9, 1));
  for (int i = 0; i < 600; ++i) tick();
  const double where = robot().joints[0].position;
  sut_->send(StopMotion{kSlot});
  const int ticks = run_until_it_stands();
  EXPECT_NEAR(ticks, 250, 2);
  EXPECT_NEAR(robot().joints[0].position, where + 0.5 * 0.5 / (2 * 2.0), 1e-9);
  EXPECT_EQ(robot().motion.outcome, motion::Outcome::stopped);
}

TEST_F(EngineMotionTest, MissedPeriodsAreCaughtUpToABound) {
  send_move(*sut_, kSlot, to(0.9, 0.9, 1));
  for (int i = 0; i < 600; ++i) tick();
  double before = robot().joints[1].position;
  tick();
  const double one = robot().joints[1].position - before;
  before = robot().joints[1].position;
  tick(3);
  EXPECT_NEAR(robot().joints[1].position - before, 4 * one, 1e-9);
  before = robot().joints[1].position;
  tick(1000);
  EXPECT_NEAR(robot().joints[1].position - before, 10 * one, 1e-9);  // kLongestStep
  run_until_it_stands();
  EXPECT_NEAR(robot().joints[1].position, 0.9, 1e-12);
}

TEST_F(EngineMotionTest, LimitThatIsNarrowedUnderAMoveBlocksIt) {
  send_move(*sut_, kSlot, to(0.9, 0.9, 1));
  for (int i = 0; i < 300; ++i) tick();
  send_limits(*sut_, kSlot, robot_of(kJoints, -1.0, 0.5).limits);
  run_until_it_stands();
  EXPECT_EQ(robot().motion.outcome, motion::Outcome::blocked);
  EXPECT_EQ(robot().refused_setpoints, 1U);
  EXPECT_LE(robot().joints[0].position, 0.5 + kLimitSlack);
  EXPECT_EQ(robot().joints[0].velocity, 0.0);
}

TEST_F(EngineMotionTest, JointBeyondANarrowedLimitCanBeMovedBackAndNotFurther) {
  JointLimits limits = robot_of(kJoints, -1.0, 1.0).limits;
  limits.upper[0] = 0.0;  // it stands at 0.1
  send_limits(*sut_, kSlot, limits);
  send_move(*sut_, kSlot, to(0.15, 0.2, 1));
  run_until_it_stands();
  EXPECT_EQ(robot().motion.outcome, motion::Outcome::blocked);
  EXPECT_EQ(robot().joints[0].position, 0.1);
  send_move(*sut_, kSlot, to(-0.1, 0.2, 2));
  run_until_it_stands();
  EXPECT_EQ(robot().motion.outcome, motion::Outcome::arrived);
  EXPECT_NEAR(robot().joints[0].position, -0.1, 1e-12);
}

TEST_F(EngineMotionTest, MoveThatIsNoNumberIsRefusedAndEndsAsBlocked) {
  motion::Move move = to(0.9, 0.9, 1);
  move.target[1] = std::numeric_limits<double>::quiet_NaN();
  send_move(*sut_, kSlot, move);
  tick();
  tick();
  EXPECT_EQ(ticks_.newest().commands_refused, 1U);
  EXPECT_EQ(robot().motion.finished, 1U);
  EXPECT_EQ(robot().motion.outcome, motion::Outcome::blocked);
  EXPECT_FALSE(robot().motion.moving);
}

TEST_F(EngineMotionTest, MovesAreGivenBackWhenTheTickHasTakenThem) {
  for (std::uint32_t id = 1; id <= 100; ++id) ASSERT_NE(send_move(*sut_, kSlot, to(0.9, 0.9, id)), 0U);
  EXPECT_EQ(sut_->lent(), 100U);
  tick();
  sut_->free_returned();
  EXPECT_EQ(sut_->lent(), 0U);
}

TEST_F(EngineMotionTest, RemovedRobotForgetsItsMoves) {
  send_move(*sut_, kSlot, to(0.9, 0.9, 1));
  tick();
  sut_->send(RemoveRobot{kSlot});
  tick();
  EXPECT_EQ(robot().mode, RobotMode::absent);
  send_robot(*sut_, kSlot, robot_of(kJoints, -1.0, 1.0));
  tick();
  EXPECT_FALSE(robot().motion.moving);
  EXPECT_EQ(robot().motion.finished, 0U);
  EXPECT_EQ(robot().joints[0].position, 0.0);
}

// A robot of three sliding axes in another slot.
class EngineLinearTest : public EngineMotionTest {
 protected:
  static constexpr std::uint8_t kGantry = 5;
  EngineLinearTest() { send_robot(*sut_, kGantry, robot_of(3, -2.0, 2.0)); }
  std::uint64_t set_chain(std::shared_ptr<const kinematics::Chain> chain) {
    return sut_->send(SetChain{.slot = kGantry, .chain = sut_->lend(std::move(chain))});
  }
  static std::shared_ptr<const kinematics::Chain> copy_of(const kinematics::Chain& chain) {
    return std::make_shared<const kinematics::Chain>(chain);
  }
  std::size_t lent_after_a_tick() {
    tick();
    sut_->free_returned();
    return sut_->lent();
  }
  motion::Move line_to(double x, double y, std::uint32_t id) {
    RobotParameters parameters;
    parameters.max_velocity.fill(1.0);
    parameters.linear_velocity = 0.5;
    parameters.inverse_class = InverseClass::align_pos;
    parameters.fly_parameter = 0.02;
    Pose X_BG = Pose::Identity();
    X_BG.translation() = Eigen::Vector3d(x, y, 0);
    motion::Move move = motion::plan_linear_move(chain_, parameters, {}, X_BG).value().move;
    move.id = id;
    move.start = motion::Start::queue;
    return move;
  }
  const RobotTickState& gantry() { return ticks_.newest().robots[kGantry]; }
  const kinematics::Chain chain_ = motion::test_arms::gantry();
};

TEST_F(EngineLinearTest, LineIsRefusedWithoutAChainAndCarriedOutWithOne) {
  send_move(*sut_, kGantry, line_to(0.3, 0.1, 1));
  tick();
  EXPECT_EQ(ticks_.newest().commands_refused, 1U);
  set_chain(copy_of(chain_));
  send_move(*sut_, kGantry, line_to(0.3, 0.1, 2));
  int ticks = 0;
  do {
    tick();
    EXPECT_NEAR(gantry().joints[1].position, gantry().joints[0].position / 3, 1e-6);
  } while (gantry().motion.moving && ++ticks < 5000);
  EXPECT_EQ(gantry().motion.finished, 2U);
  EXPECT_EQ(gantry().motion.outcome, motion::Outcome::arrived);
  EXPECT_NEAR(gantry().joints[0].position, 0.3, 1e-9);
  EXPECT_EQ(gantry().refused_setpoints, 0U);
}

TEST_F(EngineLinearTest, ChainOfAnotherNumberOfJointsIsRefused) {
  set_chain(copy_of(motion::test_arms::puma()));
  tick();
  EXPECT_EQ(ticks_.newest().commands_refused, 1U);
}

TEST_F(EngineLinearTest, ChainStaysAsLongAsMovesNeedIt) {
  const auto first = copy_of(chain_);
  set_chain(first);
  send_move(*sut_, kGantry, line_to(0.3, 0.1, 1));
  send_move(*sut_, kGantry, line_to(0.6, 0.1, 2));
  EXPECT_EQ(lent_after_a_tick(), 1U);
  set_chain(copy_of(chain_));
  set_chain(copy_of(chain_));
  EXPECT_EQ(lent_after_a_tick(), 2U) << "the one between has no moves";
  for (int i = 0; i < 5000 && gantry().motion.finished < 2; ++i) {
    const std::size_t lent = lent_after_a_tick();
    ASSERT_EQ(lent, gantry().motion.finished < 2 ? 2U : 1U);
  }
  EXPECT_EQ(first.use_count(), 1);
  EXPECT_EQ(gantry().motion.outcome, motion::Outcome::arrived);
}

TEST_F(EngineLinearTest, ChainsOfMovesThatWaitDoNotAddUp) {
  const auto one = copy_of(chain_);
  const auto other = copy_of(chain_);
  for (std::uint32_t id = 1; id <= motion::kMoveQueue; ++id) {
    set_chain(id % 2 == 0 ? one : other);
    send_move(*sut_, kGantry, line_to(0.1, 0.1, id));
  }
  EXPECT_EQ(lent_after_a_tick(), 2U);
  set_chain(one);
  set_chain({});
  EXPECT_EQ(lent_after_a_tick(), 2U);
  for (std::uint32_t id = 1; id <= 2 * motion::kMoveQueue; ++id) {
    set_chain(copy_of(chain_));
    send_move(*sut_, kGantry, line_to(0.1, 0.1, motion::kMoveQueue + id));
  }
  EXPECT_LE(lent_after_a_tick(), motion::kMoveQueue + 2);
  sut_->send(SetMode{.slot = kGantry, .mode = RobotMode::mirrored});
  EXPECT_EQ(lent_after_a_tick(), 0U);
}

TEST_F(EngineLinearTest, ARobotThatIsRemovedGivesItsChainsBack) {
  set_chain(copy_of(chain_));
  send_move(*sut_, kGantry, line_to(0.3, 0.1, 1));
  set_chain(copy_of(chain_));
  EXPECT_EQ(lent_after_a_tick(), 2U);
  sut_->send(RemoveRobot{kGantry});
  EXPECT_EQ(lent_after_a_tick(), 0U);
}

TEST_F(EngineLinearTest, TickWithLinesInCornersLeavesTheHeapAlone) {
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  set_chain(copy_of(chain_));
  for (std::uint32_t id = 1; id <= 12; ++id) send_move(*sut_, kGantry, line_to(0.1 * id, id % 2 == 0 ? 0.1 : -0.1, id));
  const AllocationGuard guard;
  for (int i = 0; i < 3000; ++i) tick();
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(guard.frees(), 0U);
  EXPECT_GT(gantry().motion.finished, 2U);
  EXPECT_EQ(gantry().refused_setpoints, 0U);
}

TEST_F(EngineMotionTest, TickWithMovingRobotsLeavesTheHeapAlone) {
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  for (std::uint32_t id = 1; id < 20; ++id) {
    motion::Move move = to(id % 2 == 0 ? 0.4 : 0.5, 0.2, id);
    move.start = id % 4 == 0 ? motion::Start::supersede : motion::Start::queue;
    send_move(*sut_, kSlot, move);
  }
  const AllocationGuard guard;
  for (int i = 0; i < 2000; ++i) tick();
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(guard.frees(), 0U);
}

TEST_F(EngineMotionTest, PaceHoldsARobotOnItsWayAndTellsSo) {
  ASSERT_NE(send_move(*sut_, kSlot, to(0.9, 0.2, 1)), 0U);
  for (int i = 0; i < 600; ++i) tick();
  ASSERT_NE(sut_->send(SetPace{.slot = kSlot, .pace = 0}), 0U);
  for (int i = 0; i < 300; ++i) tick();
  const RobotTickState held = ticks_.newest().robots[kSlot];
  EXPECT_EQ(held.motion.pace, 0);
  EXPECT_TRUE(held.motion.moving);
  EXPECT_EQ(held.joints[0].velocity, 0);
  for (int i = 0; i < 100; ++i) tick();
  EXPECT_EQ(ticks_.newest().robots[kSlot].joints[0].position, held.joints[0].position);
  ASSERT_NE(sut_->send(SetPace{.slot = kSlot, .pace = 1}), 0U);
  for (int i = 0; i < 3000; ++i) tick();
  const RobotTickState& there = ticks_.newest().robots[kSlot];
  EXPECT_NEAR(there.joints[0].position, 0.9, 1e-12);
  EXPECT_EQ(there.motion.finished, 1U);
  EXPECT_EQ(ticks_.newest().commands_refused, 0U);
}

TEST_F(EngineMotionTest, MovesEndBetweenTicksByTheSlotsOfTheirPeriods) {
  ASSERT_NE(send_move(*sut_, kSlot, to(0.6, 0.2, 1)), 0U);
  const Timestamp begun = now_;  // the first tick leads from here to the next one
  for (int i = 0; i < 3000; ++i) tick();
  // 0.5 rad at 0.5 rad/s and 2 rad/s2
  EXPECT_NEAR(seconds(ticks_.newest().robots[kSlot].motion.finished_time - begun), 1.25, 1e-8);
}

}  // namespace
}  // namespace cellmirror::engine
