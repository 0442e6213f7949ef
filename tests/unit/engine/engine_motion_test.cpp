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

namespace cellmirror::engine {
namespace {

constexpr Nanoseconds kPeriod{1'000'000};
constexpr std::uint8_t kSlot = 3;
constexpr std::uint8_t kJoints = 2;

class EngineMotionTest : public testing::Test {
 protected:
  EngineMotionTest() {
    Command command = command_of(CommandKind::add_robot);
    command.joint_count = kJoints;
    command.values = {0.1, 0.2};
    command.lower.fill(-1.0);
    command.upper.fill(1.0);
    sut_->send(command);
    tick();
  }

  static Command command_of(CommandKind kind) {
    Command command;
    command.kind = kind;
    command.slot = kSlot;
    return command;
  }

  void tick(std::uint64_t missed = 0) {
    now_ = now_ + kPeriod * static_cast<std::int64_t>(1 + missed);
    CycleContext context;
    context.now = now_;
    context.scheduled = now_;
    context.cycle = cycle_++;
    context.period = kPeriod;
    context.missed = missed;
    sut_->run(context);
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
  ASSERT_NE(sut_->send_move(kSlot, to(0.9, -0.8, 1)), 0U);
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
  sut_->send_move(kSlot, to(0.9, -0.8, 1));
  for (int i = 0; i < 1000; ++i) tick();
  EXPECT_TRUE(robot().motion.moving);
  EXPECT_EQ(robot().motion.running, 1U);
  EXPECT_NEAR(robot().joints[1].velocity, -0.5, 1e-12);
}

TEST_F(EngineMotionTest, PositionsAndMovesAreCarriedOutInTheOrderInWhichTheyWereSent) {
  Command jump = command_of(CommandKind::set_positions);
  jump.values = {0.0, 0.0};
  sut_->send(jump);
  sut_->send_move(kSlot, to(0.5, 0.5, 1));
  tick();
  EXPECT_TRUE(robot().motion.moving);
  jump.values = {-0.5, -0.5};
  sut_->send_move(kSlot, to(0.9, 0.9, 2));
  sut_->send(jump);
  tick();
  EXPECT_FALSE(robot().motion.moving);
  EXPECT_EQ(robot().joints[0].position, -0.5);
  EXPECT_EQ(robot().joints[0].velocity, 0.0);
  EXPECT_EQ(robot().motion.finished, 2U);
  EXPECT_EQ(robot().motion.finished_from, 2U);
  EXPECT_EQ(robot().motion.outcome, motion::Outcome::stopped);
}

TEST_F(EngineMotionTest, RobotThatGoesOnlineStopsAtOnceAndTakesNoMoves) {
  sut_->send_move(kSlot, to(0.9, 0.9, 1));
  for (int i = 0; i < 500; ++i) tick();
  const double where = robot().joints[0].position;
  Command online = command_of(CommandKind::set_mode);
  online.mode = RobotMode::mirrored;
  online.ages = {std::chrono::milliseconds(10), std::chrono::milliseconds(50)};
  sut_->send(online);
  tick();
  EXPECT_EQ(robot().joints[0].position, where);
  EXPECT_FALSE(robot().motion.moving);
  EXPECT_EQ(robot().motion.finished, 1U);
  sut_->send_move(kSlot, to(0.9, 0.9, 2));
  sut_->send(command_of(CommandKind::set_chain));
  sut_->send(command_of(CommandKind::stop_motion));
  tick();
  EXPECT_EQ(ticks_.newest().commands_refused, 3U);
  EXPECT_EQ(robot().joints[0].position, where);
}

TEST_F(EngineMotionTest, StopBrakesWithinTheAcceleration) {
  sut_->send_move(kSlot, to(0.9, 0.9, 1));
  for (int i = 0; i < 600; ++i) tick();
  const double where = robot().joints[0].position;
  sut_->send(command_of(CommandKind::stop_motion));
  const int ticks = run_until_it_stands();
  EXPECT_NEAR(ticks, 250, 2);
  EXPECT_NEAR(robot().joints[0].position, where + 0.5 * 0.5 / (2 * 2.0), 1e-9);
  EXPECT_EQ(robot().motion.outcome, motion::Outcome::stopped);
}

TEST_F(EngineMotionTest, MissedPeriodsAreCaughtUpToABound) {
  sut_->send_move(kSlot, to(0.9, 0.9, 1));
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
  sut_->send_move(kSlot, to(0.9, 0.9, 1));
  for (int i = 0; i < 300; ++i) tick();
  Command limits = command_of(CommandKind::set_limits);
  limits.lower.fill(-1.0);
  limits.upper.fill(0.5);
  sut_->send(limits);
  run_until_it_stands();
  EXPECT_EQ(robot().motion.outcome, motion::Outcome::blocked);
  EXPECT_EQ(robot().refused_setpoints, 1U);
  EXPECT_LE(robot().joints[0].position, 0.5 + kLimitSlack);
  EXPECT_EQ(robot().joints[0].velocity, 0.0);
}

TEST_F(EngineMotionTest, JointBeyondANarrowedLimitCanBeMovedBackAndNotFurther) {
  Command limits = command_of(CommandKind::set_limits);
  limits.lower.fill(-1.0);
  limits.upper = {0.0, 1.0};  // it stands at 0.1
  sut_->send(limits);
  sut_->send_move(kSlot, to(0.15, 0.2, 1));
  run_until_it_stands();
  EXPECT_EQ(robot().motion.outcome, motion::Outcome::blocked);
  EXPECT_EQ(robot().joints[0].position, 0.1);
  sut_->send_move(kSlot, to(-0.1, 0.2, 2));
  run_until_it_stands();
  EXPECT_EQ(robot().motion.outcome, motion::Outcome::arrived);
  EXPECT_NEAR(robot().joints[0].position, -0.1, 1e-12);
}

TEST_F(EngineMotionTest, MoveThatIsNoNumberIsRefusedAndEndsAsBlocked) {
  motion::Move move = to(0.9, 0.9, 1);
  move.target[1] = std::numeric_limits<double>::quiet_NaN();
  sut_->send_move(kSlot, move);
  tick();
  tick();
  EXPECT_EQ(ticks_.newest().commands_refused, 1U);
  EXPECT_EQ(robot().motion.finished, 1U);
  EXPECT_EQ(robot().motion.outcome, motion::Outcome::blocked);
  EXPECT_FALSE(robot().motion.moving);
}

TEST_F(EngineMotionTest, MoreMovesThanTheirStoreAreRefusedUntilATickHasTakenThem) {
  for (std::size_t i = 0; i < kMoveCommands; ++i)
    ASSERT_NE(sut_->send_move(kSlot, to(0.9, 0.9, static_cast<std::uint32_t>(i + 1))), 0U);
  EXPECT_EQ(sut_->send_move(kSlot, to(0.9, 0.9, 1000)), 0U);
  tick();
  EXPECT_NE(sut_->send_move(kSlot, to(0.9, 0.9, 1000)), 0U);
}

TEST_F(EngineMotionTest, RemovedRobotForgetsItsMoves) {
  sut_->send_move(kSlot, to(0.9, 0.9, 1));
  tick();
  sut_->send(command_of(CommandKind::remove_robot));
  tick();
  EXPECT_EQ(robot().mode, RobotMode::absent);
  Command add = command_of(CommandKind::add_robot);
  add.joint_count = kJoints;
  add.lower.fill(-1.0);
  add.upper.fill(1.0);
  sut_->send(add);
  tick();
  EXPECT_FALSE(robot().motion.moving);
  EXPECT_EQ(robot().motion.finished, 0U);
  EXPECT_EQ(robot().joints[0].position, 0.0);
}

// A robot of three sliding axes in another slot.
class EngineLinearTest : public EngineMotionTest {
 protected:
  static constexpr std::uint8_t kGantry = 5;
  EngineLinearTest() {
    Command command = command_of(CommandKind::add_robot);
    command.slot = kGantry;
    command.joint_count = 3;
    command.lower.fill(-2.0);
    command.upper.fill(2.0);
    sut_->send(command);
  }
  std::uint64_t set_chain(const kinematics::Chain* chain) {
    Command command = command_of(CommandKind::set_chain);
    command.slot = kGantry;
    command.chain = chain;
    return sut_->send(command);
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
  sut_->send_move(kGantry, line_to(0.3, 0.1, 1));
  tick();
  EXPECT_EQ(ticks_.newest().commands_refused, 1U);
  set_chain(&chain_);
  sut_->send_move(kGantry, line_to(0.3, 0.1, 2));
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
  const kinematics::Chain six = motion::test_arms::puma();
  set_chain(&six);
  tick();
  EXPECT_EQ(ticks_.newest().commands_refused, 1U);
}

TEST_F(EngineLinearTest, TickWithLinesInCornersLeavesTheHeapAlone) {
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  set_chain(&chain_);
  for (std::uint32_t id = 1; id <= 12; ++id) sut_->send_move(kGantry, line_to(0.1 * id, id % 2 == 0 ? 0.1 : -0.1, id));
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
    sut_->send_move(kSlot, move);
  }
  const AllocationGuard guard;
  for (int i = 0; i < 2000; ++i) tick();
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(guard.frees(), 0U);
}

TEST_F(EngineMotionTest, PaceHoldsARobotOnItsWayAndTellsSo) {
  ASSERT_NE(sut_->send_move(kSlot, to(0.9, 0.2, 1)), 0U);
  for (int i = 0; i < 600; ++i) tick();
  Command pace = command_of(CommandKind::set_pace);
  pace.pace = 0;
  ASSERT_NE(sut_->send(pace), 0U);
  for (int i = 0; i < 300; ++i) tick();
  const RobotTickState held = ticks_.newest().robots[kSlot];
  EXPECT_EQ(held.motion.pace, 0);
  EXPECT_TRUE(held.motion.moving);
  EXPECT_EQ(held.joints[0].velocity, 0);
  for (int i = 0; i < 100; ++i) tick();
  EXPECT_EQ(ticks_.newest().robots[kSlot].joints[0].position, held.joints[0].position);
  pace.pace = 1;
  ASSERT_NE(sut_->send(pace), 0U);
  for (int i = 0; i < 3000; ++i) tick();
  const RobotTickState& there = ticks_.newest().robots[kSlot];
  EXPECT_NEAR(there.joints[0].position, 0.9, 1e-12);
  EXPECT_EQ(there.motion.finished, 1U);
  EXPECT_EQ(ticks_.newest().commands_refused, 0U);
}

TEST_F(EngineMotionTest, MovesEndBetweenTicksByTheSlotsOfTheirPeriods) {
  ASSERT_NE(sut_->send_move(kSlot, to(0.6, 0.2, 1)), 0U);
  const Timestamp begun = now_;  // the first tick leads from here to the next one
  for (int i = 0; i < 3000; ++i) tick();
  // 0.5 rad at 0.5 rad/s and 2 rad/s2
  EXPECT_NEAR(seconds(ticks_.newest().robots[kSlot].motion.finished_time - begun), 1.25, 1e-8);
}

}  // namespace
}  // namespace cellmirror::engine
