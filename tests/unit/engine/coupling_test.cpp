// Robots that follow others (MASTER_SLAVE), in the tick.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "rt_core/engine/engine.hpp"
#include "rt_core/rt/allocation_guard.hpp"
#include "tests/unit/engine/commands.hpp"

namespace cellmirror::engine {
namespace {

constexpr std::uint8_t kMaster = 5;  // behind the slaves, so that the order of the slots is not that of dependence
constexpr std::uint8_t kSlave = 1;
constexpr std::uint8_t kSecond = 0;
constexpr double kFast = 1.0;

class CouplingTest : public testing::Test {
 protected:
  CouplingTest() {
    for (const std::uint8_t slot : {kMaster, kSlave, kSecond}) add(slot);
    tick();
  }

  void add(std::uint8_t slot) { send_robot(*sut_, slot, robot_of(3, -0.5, slot == kMaster ? 10.0 : 0.5)); }

  // The slave's joints 0 and 2 follow the master's 1 and 0.
  static Coupling coupling(std::uint8_t master, std::uint8_t slave, double max_velocity = kFast) {
    Coupling coupling{.master = master, .slave = slave, .count = 2};
    coupling.joints[0] = {.master_joint = 1, .slave_joint = 0};
    coupling.joints[1] = {.master_joint = 0, .slave_joint = 2};
    coupling.max_velocity.fill(max_velocity);
    return coupling;
  }

  void put(std::uint8_t slot, double a, double b, double c) {
    sut_->send(SetPositions{.slot = slot, .positions = {a, b, c}});
  }

  // Whether the tick took the command.
  bool accepts(Command command) {
    const std::uint64_t before = ticks_.newest().commands_refused;
    sut_->send(command);
    tick();
    return ticks_.newest().commands_refused == before;
  }
  bool accepts(const Coupling& coupling) {
    return accepts(Couple{sut_->lend(std::make_shared<const Coupling>(coupling))});
  }

  void tick(int times = 1) { run_cycles(*sut_, now_, cycle_, times); }

  const RobotTickState& robot(std::uint8_t slot) { return ticks_.newest().robots[slot]; }
  double position(std::uint8_t slot, std::size_t joint) { return robot(slot).joints[joint].position; }

  void mirror_master() {
    sut_->send(SetMode{
        .slot = kMaster, .mode = RobotMode::mirrored, .ages = {Nanoseconds(10'000'000), Nanoseconds(50'000'000)}});
  }
  void sample(double value) {
    JointSample sample;
    sample.receive_time = now_ + kPeriod;
    sample.present = 0b111;
    sample.position.fill(value);
    sut_->inlet(kMaster).push(sample);
  }

  Watchdog watchdog_{std::chrono::milliseconds(100), {}};
  std::unique_ptr<Engine> sut_ = std::make_unique<Engine>(watchdog_);
  TickReader& ticks_ = sut_->subscribe("test");
  Timestamp now_{1'000'000'000};
  std::uint64_t cycle_ = 0;
};

TEST_F(CouplingTest, CoupledJointsFollowByNameAndTheOthersStay) {
  ASSERT_TRUE(accepts(coupling(kMaster, kSlave)));
  put(kMaster, 0.2, 0.1, 0.4);
  tick(201);
  EXPECT_DOUBLE_EQ(position(kSlave, 0), 0.1);
  EXPECT_DOUBLE_EQ(position(kSlave, 1), 0.0);
  EXPECT_DOUBLE_EQ(position(kSlave, 2), 0.2);
  EXPECT_EQ(robot(kSlave).follow.joints, 0b101);
  EXPECT_EQ(robot(kSlave).follow.master, kMaster);
  EXPECT_EQ(robot(kSlave).follow.limited, 0);
  EXPECT_EQ(robot(kSlave).joints[0].velocity, 0.0);
}

TEST_F(CouplingTest, ASlaveIsNotFasterThanItsOwnLimitAndTellsThatItLags) {
  ASSERT_TRUE(accepts(coupling(kMaster, kSlave, 0.5)));
  put(kMaster, 0.0, 0.4, 0.0);
  tick();
  EXPECT_NEAR(position(kSlave, 0), 0.5e-3, 1e-12);
  EXPECT_NEAR(robot(kSlave).joints[0].velocity, 0.5, 1e-9);
  EXPECT_EQ(robot(kSlave).follow.limited, 0b001);
  double before = position(kSlave, 0);
  for (int i = 0; i < 900; ++i) {
    tick();
    ASSERT_LE(std::abs(position(kSlave, 0) - before), 0.5e-3 + 1e-12);
    before = position(kSlave, 0);
  }
  EXPECT_DOUBLE_EQ(before, 0.4);
  EXPECT_EQ(robot(kSlave).follow.limited, 0);
}

// The master jumps: what a slave makes of it is a motion.
TEST_F(CouplingTest, ASlaveStaysWithinItsAccelerationAlsoAtTheEndOfItsRangeAndWhenItHolds) {
  constexpr double kHardest = 15.0;
  Coupling limited = coupling(kMaster, kSlave);
  limited.max_acceleration.fill(kHardest);
  ASSERT_TRUE(accepts(limited));
  double before = position(kSlave, 0);
  double velocity = 0;
  double hardest = 0;
  const auto watch = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      tick();
      const double now = (position(kSlave, 0) - before) / 1e-3;
      hardest = std::max(hardest, std::abs(now - velocity) / 1e-3);
      velocity = now;
      before = position(kSlave, 0);
    }
  };
  put(kMaster, 0.0, 3.0, 0.0);
  watch(1000);
  EXPECT_NEAR(before, 0.5, 1e-9);
  put(kMaster, 0.0, -0.4, 0.0);
  watch(300);
  mirror_master();  // no data: the slave is on its way, and brakes
  watch(100);
  EXPECT_TRUE(robot(kSlave).follow.holding);
  EXPECT_EQ(velocity, 0.0);
  EXPECT_GT(before, -0.4);
  EXPECT_GT(hardest, 0.9 * kHardest);
  EXPECT_LT(hardest, 1.001 * kHardest);
  EXPECT_EQ(robot(kSlave).refused_setpoints, 0U);
}

TEST_F(CouplingTest, ASlaveStaysWithinItsRange) {
  ASSERT_TRUE(accepts(coupling(kMaster, kSlave)));
  put(kMaster, 0.0, 3.0, 0.0);
  tick(1000);
  EXPECT_DOUBLE_EQ(position(kSlave, 0), 0.5);
  EXPECT_EQ(robot(kSlave).follow.limited, 0b001);
  put(kMaster, 0.0, 0.3, 0.0);
  tick(300);
  EXPECT_DOUBLE_EQ(position(kSlave, 0), 0.3);
  EXPECT_EQ(robot(kSlave).follow.limited, 0);
}

TEST_F(CouplingTest, AValuePassesThroughAChainWithinOneTick) {
  ASSERT_TRUE(accepts(coupling(kSlave, kSecond)));
  ASSERT_TRUE(accepts(coupling(kMaster, kSlave)));
  put(kMaster, 0.0, 0.0005, 0.0);
  tick();
  EXPECT_DOUBLE_EQ(position(kSlave, 0), 0.0005);
  EXPECT_DOUBLE_EQ(position(kSecond, 2), 0.0005);
}

TEST_F(CouplingTest, ASlaveOfAMirroredMasterHoldsWhileItsDataAreNotFresh) {
  ASSERT_TRUE(accepts(coupling(kMaster, kSlave)));
  mirror_master();
  tick();
  EXPECT_TRUE(robot(kSlave).follow.holding);  // nothing has come yet
  sample(0.0004);
  tick();
  EXPECT_FALSE(robot(kSlave).follow.holding);
  EXPECT_DOUBLE_EQ(position(kSlave, 0), 0.0004);
  sample(0.4);
  tick();
  const double on_its_way = position(kSlave, 0);
  EXPECT_LT(on_its_way, 0.01);
  tick(20);  // the data are stale after 10 ms
  EXPECT_TRUE(robot(kSlave).follow.holding);
  const double held = position(kSlave, 0);
  EXPECT_LT(held, on_its_way + 0.0115);
  tick(100);
  EXPECT_DOUBLE_EQ(position(kSlave, 0), held);
  EXPECT_EQ(robot(kSlave).joints[0].velocity, 0.0);
  sample(0.4);
  tick();
  EXPECT_GT(position(kSlave, 0), held);
}

TEST_F(CouplingTest, ValuesThatAreNotFiniteHoldToo) {
  ASSERT_TRUE(accepts(coupling(kMaster, kSlave)));
  mirror_master();
  sample(0.0004);
  tick(2);
  sample(std::numeric_limits<double>::quiet_NaN());
  tick();
  EXPECT_TRUE(robot(kSlave).follow.holding);
  EXPECT_DOUBLE_EQ(position(kSlave, 0), 0.0004);
}

TEST_F(CouplingTest, MovesLeaveCoupledJointsAndOneUnderWayIsBraked) {
  motion::Move move;
  move.id = 1;
  move.target = {0.4, 0.4, 0.4};
  move.velocity = {0.5, 0.5, 0.5};
  move.max_velocity = move.velocity;
  move.acceleration = {2.0, 2.0, 2.0};
  send_move(*sut_, kSlave, move);
  tick(300);
  ASSERT_TRUE(robot(kSlave).motion.moving);
  ASSERT_TRUE(accepts(coupling(kMaster, kSlave)));
  tick(1000);
  EXPECT_FALSE(robot(kSlave).motion.moving);
  EXPECT_EQ(robot(kSlave).motion.outcome, motion::Outcome::stopped);
  EXPECT_DOUBLE_EQ(position(kSlave, 0), 0.0);  // of the master
  EXPECT_GT(position(kSlave, 1), 0.05);
  EXPECT_LT(position(kSlave, 1), 0.35);
  move.id = 2;
  send_move(*sut_, kSlave, move);
  tick(2000);
  EXPECT_DOUBLE_EQ(position(kSlave, 0), 0.0);
  EXPECT_NEAR(position(kSlave, 1), 0.4, 1e-12);
  EXPECT_DOUBLE_EQ(position(kSlave, 2), 0.0);
  EXPECT_EQ(robot(kSlave).motion.outcome, motion::Outcome::arrived);
  put(kSlave, 0.2, 0.2, 0.2);
  tick();
  EXPECT_DOUBLE_EQ(position(kSlave, 0), 0.0);
  EXPECT_DOUBLE_EQ(position(kSlave, 1), 0.2);
}

TEST_F(CouplingTest, AnUncoupledSlaveStaysWhereItIsAndIsFree) {
  ASSERT_TRUE(accepts(coupling(kMaster, kSlave)));
  put(kMaster, 0.2, 0.1, 0.0);
  tick(300);
  ASSERT_TRUE(accepts(Uncouple{kSlave}));
  put(kMaster, 0.0, 0.0, 0.0);
  tick(300);
  EXPECT_DOUBLE_EQ(position(kSlave, 0), 0.1);
  EXPECT_FALSE(robot(kSlave).follow.follows());
  put(kSlave, 0.3, 0.3, 0.3);
  tick();
  EXPECT_DOUBLE_EQ(position(kSlave, 0), 0.3);
  EXPECT_FALSE(accepts(Uncouple{kSlave}));
}

TEST_F(CouplingTest, WhatIsNotSoundIsRefused) {
  EXPECT_FALSE(accepts(coupling(kSlave, kSlave)));
  EXPECT_FALSE(accepts(coupling(40, kSlave)));
  EXPECT_FALSE(accepts(coupling(200, kSlave)));
  EXPECT_FALSE(accepts(coupling(kMaster, 40)));
  EXPECT_FALSE(accepts(coupling(kMaster, kSlave, 0.0)));
  EXPECT_FALSE(accepts(coupling(kMaster, kSlave, std::numeric_limits<double>::infinity())));
  Coupling without_acceleration = coupling(kMaster, kSlave);
  without_acceleration.max_acceleration.fill(0.0);
  EXPECT_FALSE(accepts(without_acceleration));
  without_acceleration.max_acceleration.fill(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(accepts(without_acceleration));
  EXPECT_FALSE(accepts(Couple{}));
  Coupling wrong = coupling(kMaster, kSlave);
  wrong.count = 0;
  EXPECT_FALSE(accepts(wrong));
  wrong.count = 17;
  EXPECT_FALSE(accepts(wrong));
  wrong = coupling(kMaster, kSlave);
  wrong.joints[0] = {3, 0};
  EXPECT_FALSE(accepts(wrong));
  wrong.joints[0] = {1, 3};  // the slave has joints 0 to 2
  EXPECT_FALSE(accepts(wrong));
  wrong.joints[0] = {1, 2};  // 2 is driven already
  EXPECT_FALSE(accepts(wrong));
  mirror_master();
  EXPECT_FALSE(accepts(coupling(kSlave, kMaster)));  // a mirrored slave
}

TEST_F(CouplingTest, AllJointsOfTheLargestRobotsMayBeCoupled) {
  constexpr std::uint8_t kLarge = 7;
  constexpr std::uint8_t kLargeSlave = 8;
  for (const std::uint8_t slot : {kLarge, kLargeSlave})
    send_robot(*sut_, slot, robot_of(static_cast<std::uint8_t>(kMaxJointsPerRobot), -1.0, 1.0));
  Coupling all{.master = kLarge, .slave = kLargeSlave, .count = static_cast<std::uint8_t>(kMaxJointsPerRobot)};
  for (std::uint8_t i = 0; i < kMaxJointsPerRobot; ++i) all.joints[i] = {.master_joint = i, .slave_joint = i};
  all.max_velocity.fill(kFast);
  ASSERT_TRUE(accepts(all));
  JointValues target{};
  target.fill(0.0005);
  sut_->send(SetPositions{.slot = kLarge, .positions = target});
  tick(2);
  for (std::size_t i = 0; i < kMaxJointsPerRobot; ++i) EXPECT_DOUBLE_EQ(position(kLargeSlave, i), 0.0005) << i;
}

// Joints that become free are not where the move under way would have them: it must end at once. One that takes joints
// away is braked.
TEST_F(CouplingTest, AMoveUnderWayEndsAtOnceWhereJointsBecomeFree) {
  ASSERT_TRUE(accepts(coupling(kMaster, kSlave)));
  motion::Move move;
  move.id = 1;
  move.target = {0.0, 0.4, 0.0};
  move.velocity.fill(0.5);
  move.max_velocity = move.velocity;
  move.acceleration.fill(2.0);
  send_move(*sut_, kSlave, move);
  tick(300);
  ASSERT_TRUE(robot(kSlave).motion.moving);
  const double there = position(kSlave, 1);
  ASSERT_TRUE(accepts(Uncouple{kSlave}));
  EXPECT_FALSE(robot(kSlave).motion.moving);
  tick(10);
  EXPECT_LE(position(kSlave, 1) - there, 0.5e-3 + 1e-9) << "at most one period on";
  EXPECT_EQ(robot(kSlave).motion.outcome, motion::Outcome::stopped);
}

TEST_F(CouplingTest, CirclesAndSecondMastersAreRefused) {
  ASSERT_TRUE(accepts(coupling(kMaster, kSlave)));
  ASSERT_TRUE(accepts(coupling(kSlave, kSecond)));
  EXPECT_FALSE(accepts(coupling(kSecond, kMaster)));
  EXPECT_FALSE(accepts(coupling(kSlave, kMaster)));
  EXPECT_FALSE(accepts(coupling(kMaster, kSecond)));
  EXPECT_TRUE(accepts(coupling(kMaster, kSlave, 0.1)));  // the same master: takes its place
}

TEST_F(CouplingTest, ARobotThatVanishesTakesItsCouplingsAlong) {
  ASSERT_TRUE(accepts(coupling(kMaster, kSlave)));
  ASSERT_TRUE(accepts(coupling(kSlave, kSecond)));
  sut_->send(RemoveRobot{kSlave});
  tick();
  EXPECT_FALSE(robot(kSecond).follow.follows());
  add(kSlave);
  tick(10);
  EXPECT_FALSE(robot(kSlave).follow.follows());
  put(kMaster, 0.1, 0.1, 0.1);
  tick(200);
  EXPECT_DOUBLE_EQ(position(kSlave, 0), 0.0);
}

TEST_F(CouplingTest, SlotsBeyondTheCapacityAreRefused) {
  const auto capacity = static_cast<std::uint8_t>(sut_->capacity().robots);
  EXPECT_FALSE(accepts(coupling(capacity, kSlave)));
  EXPECT_FALSE(accepts(coupling(kMaster, capacity)));
  EXPECT_FALSE(accepts(Uncouple{capacity}));
}

TEST_F(CouplingTest, CouplingAndFollowingAllocateNothing) {
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  send_coupling(*sut_, coupling(kMaster, kSlave));
  send_coupling(*sut_, coupling(kSlave, kSecond));
  put(kMaster, 0.3, 0.3, 0.3);
  const AllocationGuard guard;
  tick(100);
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cellmirror::engine
