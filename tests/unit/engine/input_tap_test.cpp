// What the tick writes for a recording, and what another engine makes of it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <vector>

#include "rt_core/engine/engine.hpp"
#include "rt_core/engine/input_commands.hpp"
#include "rt_core/engine/state_transfer.hpp"
#include "rt_core/rt/allocation_guard.hpp"
#include "tests/unit/engine/commands.hpp"

namespace cellmirror::engine {
namespace {

// Counts records of a stream as InputTap::drain() gives it.
std::map<InputRecord, int> kinds_of(const std::vector<std::byte>& records) {
  std::map<InputRecord, int> out;
  StateReader in(records);
  while (in.ok() && !in.at_end()) {
    std::uint8_t kind = 0;
    std::uint32_t length = 0;
    in(kind, length);
    in.skip(length);
    ++out[static_cast<InputRecord>(kind)];
  }
  EXPECT_TRUE(in.ok());
  return out;
}

class InputTapTest : public testing::Test {
 protected:
  void tick(int times = 1) { run_cycles(*sut_, now_, cycle_, times); }
  void move(std::size_t slot, std::uint32_t id, double target) {
    motion::Move one;
    one.id = id;
    one.max_velocity.fill(10);
    one.velocity.fill(1);
    one.acceleration.fill(4);
    one.target.fill(target);
    send_move(*sut_, slot, one);
  }

  Watchdog watchdog_{std::chrono::milliseconds(100), {}};
  std::unique_ptr<Engine> sut_ = std::make_unique<Engine>(watchdog_, EngineCapacity{.robots = 8});
  TickReader& ticks_ = sut_->subscribe("test");
  Timestamp now_{1'000'000'000};
  std::uint64_t cycle_ = 0;
};

TEST_F(InputTapTest, NothingIsWrittenWhileNothingRecords) {
  send_robot(*sut_, 0, robot_of(3, -1, 1));
  tick(10);
  std::vector<std::byte> records;
  EXPECT_FALSE(sut_->inputs().drain(records));
}

TEST_F(InputTapTest, ARecordingBeginsWithAStartStateAndHasEachTick) {
  send_robot(*sut_, 0, robot_of(3, -1, 1));
  tick(5);
  sut_->inputs().request_start();
  move(0, 1, 0.5);
  tick(20);
  std::vector<std::byte> records;
  ASSERT_TRUE(sut_->inputs().drain(records));
  auto kinds = kinds_of(records);
  EXPECT_EQ(kinds[InputRecord::start], 1);
  EXPECT_EQ(kinds[InputRecord::command], 1);
  EXPECT_EQ(kinds[InputRecord::tick], 20);
}

TEST_F(InputTapTest, CommandsThatWereSentBeforeAreDoneBeforeTheFirstTickIsRecorded) {
  for (int i = 0; i < kCommandsPerTick + 10; ++i) send_robot(*sut_, 0, robot_of(3, -1, 1));
  sut_->inputs().request_start();
  tick(3);
  std::vector<std::byte> records;
  ASSERT_TRUE(sut_->inputs().drain(records));
  auto kinds = kinds_of(records);
  EXPECT_EQ(kinds[InputRecord::command], 0);
  EXPECT_EQ(kinds[InputRecord::tick], 1) << "the two ticks that took them are not recorded";
}

TEST_F(InputTapTest, TheTickAllocatesNothingForARecording) {
  ASSERT_TRUE(AllocationGuard::armed());
  for (std::size_t slot = 0; slot < 8; ++slot) send_robot(*sut_, slot, robot_of(6, -1, 1));
  tick();
  sut_->inputs().request_start();
  for (std::uint32_t slot = 0; slot < 8; ++slot) move(slot, 1, 0.9);
  const AllocationGuard guard;
  tick(200);
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST_F(InputTapTest, WhatFindsNoRoomIsLeftOutWholeAndAnotherStartStateFollows) {
  for (std::size_t slot = 0; slot < 8; ++slot) send_robot(*sut_, slot, robot_of(16, -1, 1));
  tick();
  sut_->inputs().request_start();
  std::vector<std::byte> records;
  for (std::uint32_t turn = 1; sut_->inputs().lost_ticks() == 0; ++turn) {
    for (std::uint32_t slot = 0; slot < 8; ++slot) move(slot, turn, turn % 2 == 0 ? 0.5 : -0.5);
    tick(100);
    ASSERT_LT(turn, 1000U) << "the ring is never full";
  }
  ASSERT_TRUE(sut_->inputs().drain(records));
  EXPECT_EQ(kinds_of(records)[InputRecord::start], 1);
  records.clear();
  tick(3);
  ASSERT_TRUE(sut_->inputs().drain(records));
  auto kinds = kinds_of(records);
  EXPECT_EQ(kinds[InputRecord::start], 1);
  EXPECT_EQ(kinds[InputRecord::tick], 3);
}

// Of each kind one, as it is after its way through bytes.
class CommandBytesTest : public testing::Test {
 protected:
  std::optional<Command> read(std::span<const std::byte> bytes) {
    StateReader in(bytes);
    return read_command(in, {.engine = engine_,
                             .chain =
                                 [](std::uint64_t, kinematics::Chain&& chain) {
                                   return std::make_shared<const kinematics::Chain>(std::move(chain));
                                 },
                             .device = [](std::uint8_t, std::uint64_t) { return std::make_shared<Device>(); }});
  }
  // The bytes of what was read are the bytes that it was read from.
  void expect_same(Command command) {
    std::vector<std::byte> first(std::size_t{64} << 10);
    StateWriter out(first);
    write_command(out, command);
    ASSERT_TRUE(out.ok());
    auto again = read(out.written());
    ASSERT_TRUE(again.has_value());
    std::vector<std::byte> second(std::size_t{64} << 10);
    StateWriter out_again(second);
    write_command(out_again, *again);
    // But for ids of what is lent.
    ASSERT_EQ(out.size(), out_again.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < out.size(); ++i) different += first[i] != second[i] ? 1 : 0;
    EXPECT_LE(different, 8U);
    for (std::size_t cut = 0; cut < out.size(); cut += 7) EXPECT_FALSE(read(out.written().first(cut)).has_value());
  }

  struct Device final : HapticDevicePort {
    HapticRead read(HapticSample& /*sample*/) CELL_RT override { return HapticRead::none; }
    void write(const HapticOutput& /*output*/) CELL_RT override {}
  };

  static kinematics::Chain chain() {
    kinematics::ChainJoint joint;
    joint.X_PJ.translation().x() = 0.3;
    return *kinematics::Chain::make({{"A", JointKind::revolute, -1, 1}}, std::span(&joint, 1), Pose::Identity());
  }
  template <class T>
  Lease<const T> lend(T object) {
    return engine_.lend(std::make_shared<const T>(std::move(object)));
  }

  Watchdog watchdog_{std::chrono::milliseconds(100), {}};
  Engine engine_{watchdog_, EngineCapacity{.robots = 2}};
};

TEST_F(CommandBytesTest, EachCommandComesBackAsItWas) {
  motion::Move move;
  move.kind = motion::MoveKind::linear;
  move.id = 7;
  move.X_BG.translation() = Eigen::Vector3d(1, 2, 3);
  Coupling coupling;
  coupling.slave = 1;
  coupling.count = 1;
  coupling.max_velocity.fill(2);
  haptics::Instrument instrument{.chain = chain(), .settings = {}};
  instrument.joint_count = 1;
  expect_same(RobotCommand(AddRobot{.slot = 1, .robot = lend(robot_of(3, -1, 1))}));
  expect_same(RobotCommand(RemoveRobot{.slot = 1}));
  expect_same(RobotCommand(SetMode{
      .slot = 1, .mode = RobotMode::mirrored, .given = 3, .ages = {}, .plausibility = lend(PlausibilityBounds())}));
  expect_same(RobotCommand(SetPositions{.slot = 1, .positions = {0.1, 0.2}}));
  expect_same(RobotCommand(SetLimits{.slot = 1, .limits = lend(JointLimits())}));
  expect_same(MotionCommand(SetChain{.slot = 1, .chain = lend(chain())}));
  expect_same(MotionCommand(SetChain{.slot = 1}));
  expect_same(MotionCommand(AddMove{.slot = 1, .move = lend(move)}));
  expect_same(MotionCommand(StopMotion{.slot = 1}));
  expect_same(MotionCommand(SetPace{.slot = 1, .pace = 0.25}));
  expect_same(MotionCommand(HoldBehind{.slot = 1, .move = 4}));
  expect_same(CouplingCommand(Couple{lend(coupling)}));
  expect_same(CouplingCommand(Uncouple{.slot = 1}));
  expect_same(HapticCommand(OpenHaptic{.channel = 1,
                                       .instrument = lend(std::move(instrument)),
                                       .device = engine_.lend<HapticDevicePort>(std::make_shared<Device>())}));
  expect_same(HapticCommand(CloseHaptic{.channel = 1}));
  expect_same(HapticCommand(ResetHaptic{.channel = 1}));
  expect_same(HapticCommand(SetDeviceGone{.channel = 1, .gone = true}));
}

// Before slaves had accelerations.
TEST_F(CommandBytesTest, ACouplingOfAnOlderRecordingIsRead) {
  std::vector<std::byte> bytes(1024);
  StateWriter out(bytes);
  std::uint8_t master = 3;
  std::uint8_t slave = 1;
  JointValues velocity{};
  velocity.fill(2);
  std::uint16_t count = 2;
  out(master, slave, velocity);
  out.bounded(count, kMaxJointsPerRobot);
  for (std::uint8_t i = 0; i < 2 * kMaxJointsPerRobot; ++i) out(i);
  StateReader in(out.written());
  Coupling found;
  transfer(in, found);
  EXPECT_TRUE(in.ok());
  EXPECT_TRUE(in.at_end());
  EXPECT_EQ(found.master, 3);
  EXPECT_EQ(found.count, 2);
  EXPECT_EQ(found.joints[1].master_joint, 2);
  EXPECT_EQ(found.max_velocity[0], 2);
  EXPECT_EQ(found.max_acceleration[0], std::numeric_limits<double>::infinity());
}

TEST_F(CommandBytesTest, AModeThatNoOwnerSetsIsRefused) {
  std::vector<std::byte> bytes(1024);
  StateWriter out(bytes);
  Command command = RobotCommand(SetMode{.slot = 1, .mode = RobotMode::absent});
  write_command(out, command);
  EXPECT_FALSE(read(out.written()).has_value());
}

}  // namespace
}  // namespace cellmirror::engine
