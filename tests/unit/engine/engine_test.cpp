#include "rt_core/engine/engine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "rt_core/rt/allocation_guard.hpp"
#include "tests/unit/engine/commands.hpp"

namespace cellmirror::engine {
namespace {

class EngineTest : public testing::Test {
 protected:
  void make(const EngineCapacity& capacity) {
    sut_ = std::make_unique<Engine>(watchdog_, capacity);
    ticks_ = &sut_->subscribe("test");
  }

  void tick(Nanoseconds after = kPeriod) {
    now_ = now_ + after;
    run_cycle(*sut_, now_, cycle_);
  }

  std::uint64_t add_robot(std::size_t slot = 3, std::uint8_t joints = 2) {
    return send_robot(*sut_, slot, robot_of(joints, -1.0, 1.0, {0.1, 0.2}));
  }

  void mirror(std::size_t slot = 3, std::uint16_t given = 0xFFFF) {
    sut_->send(SetMode{.slot = slot_number(slot),
                       .mode = RobotMode::mirrored,
                       .given = given,
                       .ages = {std::chrono::milliseconds(10), std::chrono::milliseconds(50)}});
  }

  std::uint64_t set_positions(double a, double b, std::size_t slot = 3) {
    return sut_->send(SetPositions{.slot = slot_number(slot), .positions = {a, b}});
  }

  [[nodiscard]] JointSample sample(std::uint64_t sequence, double a, double b, std::uint32_t present = 3) const {
    JointSample out;
    out.receive_time = now_;
    out.sequence = sequence;
    out.present = present;
    out.position = {a, b};
    return out;
  }

  const RobotTickState& robot(std::size_t slot = 3) { return ticks_->newest().robots[slot]; }

  Watchdog watchdog_{std::chrono::milliseconds(100), {}};
  std::unique_ptr<Engine> sut_ = std::make_unique<Engine>(watchdog_);
  TickReader* ticks_ = &sut_->subscribe("test");
  TickReader* second_ = &sut_->subscribe("second");
  Timestamp now_{1'000'000'000};
  std::uint64_t cycle_ = 0;
};

TEST_F(EngineTest, PublishesAnAddedRobotWithItsPositions) {
  const std::uint64_t id = add_robot();
  tick();
  EXPECT_EQ(ticks_->newest().commands_done, id);
  EXPECT_EQ(robot().mode, RobotMode::simulated);
  EXPECT_DOUBLE_EQ(robot().joints[1].position, 0.2);
  EXPECT_EQ(second_->newest().robots[3].joint_count, 2);
}

TEST_F(EngineTest, ReadersKeepTheirStateWhileOthersGoOn) {
  EXPECT_EQ(second_->name(), "second");
  tick();
  const TickState& held = second_->newest();
  for (int i = 0; i < 5; ++i) {
    tick();
    EXPECT_EQ(ticks_->newest().tick, cycle_ - 1);
  }
  EXPECT_EQ(held.tick, 0U);
  EXPECT_EQ(second_->newest().tick, 5U);
}

TEST_F(EngineTest, SubscribingAfterTheFirstTickBreaksTheContract) {
  tick();
  EXPECT_DEATH(sut_->subscribe("late"), "contract broken");
}

TEST_F(EngineTest, RunsWithoutReaders) {
  const auto alone = std::make_unique<Engine>(watchdog_);
  CycleContext context;
  context.period = kPeriod;
  alone->run(context);
  EXPECT_EQ(alone->flight_ticks().size(), 1U);
  EXPECT_DEATH(alone->subscribe("late"), "contract broken");
}

TEST_F(EngineTest, RemovedRobotStaysAbsentInEveryBufferOfTheEdge) {
  add_robot();
  for (int i = 0; i < 5; ++i) tick();
  sut_->send(RemoveRobot{3});
  for (int i = 0; i < 5; ++i) {
    tick();
    EXPECT_EQ(robot().mode, RobotMode::absent);
  }
}

TEST_F(EngineTest, SetPointsPassTheLimiterAsAWholeOrNotAtAll) {
  add_robot();
  set_positions(0.5, 0.6);
  tick();
  EXPECT_DOUBLE_EQ(robot().joints[0].position, 0.5);
  const std::uint64_t refused = set_positions(0.9, 1.1);
  tick();
  EXPECT_DOUBLE_EQ(robot().joints[0].position, 0.5);
  EXPECT_DOUBLE_EQ(robot().joints[1].position, 0.6);
  EXPECT_EQ(robot().refused_setpoints, 1U);
  EXPECT_EQ(ticks_->newest().commands_refused, 1U);
  EXPECT_EQ(ticks_->newest().commands_done, refused);
}

TEST_F(EngineTest, AJointThatTheStreamDoesNotGiveSaysNothingAboutTheStream) {
  add_robot();
  mirror(3, 0b01);
  sut_->inlet(3).push(sample(1, 0.3, 0.0, 0b01));
  tick();
  EXPECT_EQ(robot().state, DataState::fresh);
  EXPECT_EQ(robot().joints[1].state, DataState::none);
  EXPECT_DOUBLE_EQ(robot().joints[1].position, 0.2) << "its start position";
  tick(std::chrono::milliseconds(20));
  EXPECT_EQ(robot().state, DataState::stale);
  tick(std::chrono::milliseconds(50));
  EXPECT_EQ(robot().state, DataState::lost);
}

TEST_F(EngineTest, AStreamThatNamesNoJointIsJudgedByAll) {
  add_robot();
  mirror(3, 0);
  sut_->inlet(3).push(sample(1, 0.3, 0.0, 0b01));
  tick();
  EXPECT_EQ(robot().state, DataState::none);
}

TEST_F(EngineTest, MirroredRobotFollowsItsStreamAndRefusesSetPoints) {
  add_robot();
  mirror();
  sut_->inlet(3).push(sample(1, 0.3, 5.0));  // beyond the model's limit: what the real robot says is shown
  set_positions(0.0, 0.0);
  tick();
  EXPECT_DOUBLE_EQ(robot().joints[0].position, 0.3);
  EXPECT_DOUBLE_EQ(robot().joints[1].position, 5.0);
  EXPECT_EQ(robot().state, DataState::fresh);
  EXPECT_EQ(ticks_->newest().commands_refused, 1U);
}

TEST_F(EngineTest, StandingStillButSendingIsFreshAndSilenceAges) {
  add_robot();
  mirror();
  for (std::uint64_t i = 1; i <= 30; ++i) {
    sut_->inlet(3).push(sample(i, 0.3, 0.3));
    tick();
    ASSERT_EQ(robot().state, DataState::fresh);
  }
  tick(std::chrono::milliseconds(11));
  EXPECT_EQ(robot().state, DataState::stale);
  tick(std::chrono::milliseconds(50));
  EXPECT_EQ(robot().state, DataState::lost);
  EXPECT_DOUBLE_EQ(robot().joints[0].position, 0.3);
  sut_->inlet(3).push(sample(31, 0.4, 0.4));
  tick();
  EXPECT_EQ(robot().state, DataState::fresh);  // recovers by itself
}

TEST_F(EngineTest, MirroredRobotWithoutASampleHasNoneAndKeepsItsPlace) {
  add_robot();
  mirror();
  tick();
  EXPECT_EQ(robot().state, DataState::none);
  EXPECT_DOUBLE_EQ(robot().joints[0].position, 0.1);
}

TEST_F(EngineTest, JointsOfOneRobotAgeApart) {
  add_robot();
  mirror();
  sut_->inlet(3).push(sample(1, 0.1, 0.1));
  tick();
  tick(std::chrono::milliseconds(8));
  sut_->inlet(3).push(sample(2, 0.2, 0.0, 1));  // only the first joint
  tick(std::chrono::milliseconds(8));
  EXPECT_EQ(robot().joints[0].state, DataState::fresh);
  EXPECT_EQ(robot().joints[1].state, DataState::stale);
  EXPECT_EQ(robot().state, DataState::stale);
}

TEST_F(EngineTest, NotFiniteAndRefusedValuesLeaveTheLastGoodOneAndMarkItInvalid) {
  add_robot();
  mirror();
  sut_->inlet(3).push(sample(1, 0.1, 0.2));
  tick();
  JointSample bad = sample(2, std::numeric_limits<double>::quiet_NaN(), 0.25);
  sut_->inlet(3).push(bad);
  tick();
  EXPECT_EQ(robot().joints[0].state, DataState::invalid);
  EXPECT_DOUBLE_EQ(robot().joints[0].position, 0.1);
  EXPECT_DOUBLE_EQ(robot().joints[1].position, 0.25);
  bad = sample(3, 0.11, 0, 1);
  bad.refused = 2;
  sut_->inlet(3).push(bad);
  tick();
  EXPECT_EQ(robot().joints[0].state, DataState::fresh);
  EXPECT_EQ(robot().joints[1].state, DataState::invalid);
  EXPECT_EQ(robot().refused_values, 2U);
}

TEST_F(EngineTest, RobotThatGoesOfflineStaysWhereItWas) {
  add_robot();
  mirror();
  sut_->inlet(3).push(sample(1, 0.7, -0.7));
  tick();
  sut_->send(SetMode{.slot = 3, .mode = RobotMode::simulated});
  sut_->inlet(3).push(sample(2, 0.9, 0.9));  // left behind by a stream that is closed
  tick();
  EXPECT_EQ(robot().mode, RobotMode::simulated);
  EXPECT_DOUBLE_EQ(robot().joints[0].position, 0.7);
  mirror();
  tick();
  EXPECT_EQ(robot().samples, 0U) << "what was left behind is not of the stream that is opened next";
}

TEST_F(EngineTest, SamplesOfAStreamThatIsOpenedBeforeTheRobotIsMirroredWaitForThat) {
  add_robot();
  tick();
  sut_->inlet(3).push(sample(1, 0.7, -0.7));
  tick();
  EXPECT_DOUBLE_EQ(robot().joints[0].position, 0.1);
  mirror();
  tick();
  EXPECT_EQ(robot().samples, 1U);
  EXPECT_DOUBLE_EQ(robot().joints[0].position, 0.7);
}

TEST_F(EngineTest, RobotThatTakesTheSlotOfAnotherGetsNoneOfItsSamples) {
  add_robot();
  mirror();
  tick();
  sut_->inlet(3).push(sample(1, 0.9, 0.9));
  sut_->send(RemoveRobot{3});
  add_robot();
  tick();
  mirror();
  tick();
  EXPECT_EQ(robot().samples, 0U);
}

TEST_F(EngineTest, FullSampleQueueRefusesAndCounts) {
  add_robot();
  mirror();
  for (std::size_t i = 0; i < kSampleQueue + 5; ++i) sut_->inlet(3).push(sample(i, 0, 0));
  EXPECT_EQ(sut_->sample_queue(3).dropped, 5U);
  // The tick takes a bounded number a period, and all of them in the end.
  tick();
  EXPECT_EQ(robot().samples, static_cast<std::uint64_t>(kSamplesPerTick));
  tick();
  EXPECT_EQ(robot().samples, kSampleQueue);
}

TEST_F(EngineTest, CommandFloodIsTakenABoundedNumberATick) {
  add_robot();
  tick();
  std::uint64_t last = 0;
  for (int i = 0; i < kCommandsPerTick + 10; ++i) last = set_positions(0, 0);
  tick();
  EXPECT_EQ(ticks_->newest().commands_done, last - 10);
  tick();
  EXPECT_EQ(ticks_->newest().commands_done, last);
}

TEST_F(EngineTest, FullCommandQueueRefuses) {
  for (std::size_t i = 0; i < kCommandQueue; ++i) ASSERT_NE(set_positions(0, 0), 0U);
  EXPECT_EQ(set_positions(0, 0), 0U);
  EXPECT_EQ(sut_->command_queue().dropped, 1U);
  Command move = AddMove{.slot = 3, .move = sut_->lend(std::make_shared<const motion::Move>())};
  EXPECT_EQ(sut_->send(move), 0U);
  EXPECT_TRUE(std::get<AddMove>(std::get<MotionCommand>(move)).move) << "it can be sent again";
  tick();
  EXPECT_NE(sut_->send(move), 0U);
}

TEST_F(EngineTest, FlightRecorderHoldsTicksSamplesAndSetPoints) {
  add_robot();
  set_positions(0.5, 0.5);
  tick();
  mirror();
  sut_->inlet(3).push(sample(42, 0.6, 0.6));
  tick();
  const auto ticks = sut_->flight_ticks();
  ASSERT_EQ(ticks.size(), 2U);
  EXPECT_EQ(ticks[1].tick, 1U);
  EXPECT_EQ(ticks[1].samples, 1U);
  const auto robots = sut_->flight_robots();
  ASSERT_EQ(robots.size(), 2U);
  EXPECT_EQ(robots[0].event, FlightEvent::setpoint);
  EXPECT_EQ(robots[1].event, FlightEvent::sample);
  EXPECT_EQ(robots[1].sequence, 42U);
  EXPECT_FLOAT_EQ(robots[1].position[0], 0.6F);
}

TEST(EngineCapacity, HasRoomForTheRobotsOfTheCellAndAFewMore) {
  EXPECT_EQ(capacity_for(0).robots, kSpareRobots);
  EXPECT_EQ(capacity_for(20).robots, 20 + kSpareRobots);
  EXPECT_EQ(capacity_for(kMaxRobots - kSpareRobots).robots, kMaxRobots);
  EXPECT_EQ(capacity_for(kMaxRobots).robots, kMaxRobots);
}

TEST_F(EngineTest, SlotsBeyondTheCapacityAreRefusedAndRecordedWithoutJoints) {
  make({.robots = 4, .haptic_devices = 1});
  add_robot(3);
  tick();
  EXPECT_EQ(ticks_->newest().commands_refused, 0U);
  EXPECT_EQ(ticks_->newest().robots.size(), 4U);
  add_robot(4);
  set_positions(0, 0, 4);
  set_positions(0, 0, 255);
  tick();
  EXPECT_EQ(ticks_->newest().commands_refused, 3U);
  const auto records = sut_->flight_robots();
  ASSERT_EQ(records.size(), 3U);
  for (const FlightRobot& record : records) {
    EXPECT_EQ(record.event, FlightEvent::refused_command);
    EXPECT_EQ(record.joint_count, 0U);
  }
  EXPECT_EQ(records[0].slot, 4U);
  EXPECT_DEATH(static_cast<void>(sut_->inlet(4)), "contract broken");
  EXPECT_DEATH(static_cast<void>(sut_->sample_queue(4)), "contract broken");
  EXPECT_DEATH(static_cast<void>(sut_->contact_inlet(1)), "contract broken");
}

TEST_F(EngineTest, MoreThanTheGreatestCapacityBreaksTheContract) {
  EXPECT_DEATH(make({.robots = kMaxRobots + 1}), "contract broken");
  EXPECT_DEATH(make({.haptic_devices = kMaxHapticDevices + 1}), "contract broken");
}

TEST_F(EngineTest, TheLastOf256RobotsIsAsGoodAsTheFirst) {
  make({.robots = kMaxRobots});
  for (const std::size_t slot : {std::size_t{0}, kMaxRobots - 1}) {
    add_robot(slot);
    mirror(slot);
    sut_->inlet(slot).push(sample(1, 0.3, 0.4));
  }
  tick();
  for (const std::size_t slot : {std::size_t{0}, kMaxRobots - 1}) {
    EXPECT_EQ(robot(slot).state, DataState::fresh);
    EXPECT_DOUBLE_EQ(robot(slot).joints[1].position, 0.4);
  }
  EXPECT_EQ(robot(1).mode, RobotMode::absent);
}

TEST_F(EngineTest, TickTouchesNoHeap) {
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  make({.robots = kMaxRobots});
  for (std::size_t slot = 0; slot < kMaxRobots; ++slot) {
    add_robot(slot, kMaxJointsPerRobot);
    mirror(slot);
  }
  const AllocationGuard guard;
  for (std::uint64_t i = 0; i < 100; ++i) {
    for (std::size_t slot = 0; slot < kMaxRobots; ++slot) sut_->inlet(slot).push(sample(i, 0.1, 0.1));
    tick();
  }
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(guard.frees(), 0U);
}

}  // namespace
}  // namespace cellmirror::engine
