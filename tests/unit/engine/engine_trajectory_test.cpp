// Trajectories in the tick: beside moves, modes and couplings, and in recordings.
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <vector>

#include "rt_core/engine/engine.hpp"
#include "rt_core/engine/input_commands.hpp"
#include "rt_core/engine/trajectory_bytes.hpp"
#include "rt_core/rt/allocation_guard.hpp"
#include "tests/unit/engine/commands.hpp"

namespace cellmirror::engine {
namespace {

using motion::Trajectory;
using motion::TrajectoryOutcome;

// All joints to `target` within `duration` s.
std::shared_ptr<Trajectory> trajectory_to(std::uint32_t id, std::uint8_t joints, double target, double duration) {
  auto out = std::make_shared<Trajectory>();
  out->id = id;
  out->joints = joints;
  out->given = static_cast<std::uint16_t>((1U << joints) - 1U);
  out->max_velocity.fill(10);
  out->deceleration.fill(20);
  out->times = {duration};
  out->orders = {motion::KnotOrder::velocities};
  out->knots.assign(joints, {target, 0, 0});
  return out;
}

class EngineTrajectoryTest : public testing::Test {
 protected:
  void SetUp() override {
    send_robot(*sut_, 0, robot_of(3, -2, 2));
    tick();
  }
  void tick(int times = 1) { run_cycles(*sut_, now_, cycle_, times); }
  void follow(const std::shared_ptr<Trajectory>& trajectory) {
    ASSERT_NE(sut_->send(FollowTrajectory{0, sut_->lend(std::shared_ptr<const Trajectory>(trajectory))}), 0U);
  }
  const RobotTickState& robot() { return ticks_.newest().robots[0]; }
  void move(std::uint32_t id, double target) {
    motion::Move one;
    one.id = id;
    one.max_velocity.fill(10);
    one.velocity.fill(1);
    one.acceleration.fill(4);
    one.target.fill(target);
    send_move(*sut_, 0, one);
  }

  Watchdog watchdog_{std::chrono::milliseconds(100), {}};
  std::unique_ptr<Engine> sut_ = std::make_unique<Engine>(watchdog_, EngineCapacity{.robots = 4});
  TickReader& ticks_ = sut_->subscribe("test");
  Timestamp now_{1'000'000'000};
  std::uint64_t cycle_ = 0;
};

TEST_F(EngineTrajectoryTest, TheTickFollowsItAndGivesItBack) {
  follow(trajectory_to(1, 3, 0.5, 0.2));
  tick(100);
  EXPECT_TRUE(robot().trajectory.moving);
  EXPECT_NEAR(robot().joints[0].position, 0.25, 0.01);
  EXPECT_GT(robot().joints[0].velocity, 1);
  tick(110);
  EXPECT_EQ(robot().joints[2].position, 0.5);
  EXPECT_EQ(robot().trajectory.finished, 1U);
  EXPECT_EQ(robot().trajectory.outcome, TrajectoryOutcome::arrived);
  sut_->free_returned();
  EXPECT_EQ(sut_->lent(), 0U);
}

TEST_F(EngineTrajectoryTest, ItTakesThePlaceOfAMoveAndAMoveThatOfIt) {
  move(1, 2);
  tick(300);
  const double velocity = robot().joints[0].velocity;
  EXPECT_GT(velocity, 0.5);
  follow(trajectory_to(1, 3, 0, 1));
  tick(2);
  EXPECT_EQ(robot().motion.outcome, motion::Outcome::superseded);
  EXPECT_NEAR(robot().joints[0].velocity, velocity, 0.1) << "without a jerk";
  move(2, 1);
  tick(2);
  EXPECT_EQ(robot().trajectory.outcome, TrajectoryOutcome::superseded);
  tick(2000);
  EXPECT_NEAR(robot().joints[0].position, 1, 1e-9);
}

TEST_F(EngineTrajectoryTest, ItEndsWithTheModeTheRobotAndAStop) {
  follow(trajectory_to(1, 3, 1, 1));
  tick(500);
  sut_->send(StopMotion{0});
  tick(300);
  EXPECT_EQ(robot().trajectory.outcome, TrajectoryOutcome::stopped);
  EXPECT_FALSE(robot().trajectory.moving);
  follow(trajectory_to(2, 3, 1, 1));
  tick(100);
  sut_->send(SetMode{.slot = 0, .mode = RobotMode::mirrored});
  tick();
  EXPECT_EQ(robot().trajectory.finished, 2U);
  follow(trajectory_to(3, 3, 1, 1));
  const std::uint64_t refused = ticks_.newest().commands_refused;
  tick();
  EXPECT_EQ(ticks_.newest().commands_refused, refused + 1) << "a mirrored robot is not moved";
  sut_->send(RemoveRobot{0});
  tick();
  sut_->free_returned();
  EXPECT_EQ(sut_->lent(), 0U);
}

TEST_F(EngineTrajectoryTest, TheTickAllocatesNothing) {
  ASSERT_TRUE(AllocationGuard::armed());
  follow(trajectory_to(1, 3, 1, 0.1));
  follow(trajectory_to(2, 3, 0.5, 0.1));
  sut_->inputs().request_start();
  const AllocationGuard guard;
  tick(200);
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST_F(EngineTrajectoryTest, CommandsComeBackFromTheirBytes) {
  Command command = FollowTrajectory{2, sut_->lend(std::shared_ptr<const Trajectory>(trajectory_to(7, 3, 1, 0.1)))};
  std::vector<std::byte> bytes(most_bytes_of(command));
  StateWriter out(bytes);
  write_command(out, command);
  ASSERT_TRUE(out.ok());
  const CommandParts parts{.engine = *sut_, .chain = {}, .device = {}};
  StateReader in(out.written());
  const auto again = read_command(in, parts);
  ASSERT_TRUE(again.has_value());
  const auto* const read = std::get_if<FollowTrajectory>(&std::get<MotionCommand>(*again));
  ASSERT_NE(read, nullptr);
  EXPECT_EQ(read->slot, 2);
  EXPECT_EQ(read->trajectory->id, 7U);
  EXPECT_EQ(read->trajectory->knot(0, 2).position, 1);
  for (std::size_t cut = 0; cut < out.size(); cut += 5) {
    StateReader of_less(out.written().first(cut));
    EXPECT_FALSE(read_command(of_less, parts).has_value()) << cut;
  }
}

// A recording that begins while a trajectory runs: another engine goes on with it to the bit.
TEST_F(EngineTrajectoryTest, AStartStateHasTheTrajectoryThatRuns) {
  follow(trajectory_to(1, 3, 1, 0.5));
  tick(200);
  sut_->inputs().request_start();
  tick(1);
  std::vector<std::byte> records;
  ASSERT_TRUE(sut_->inputs().drain(records));
  std::map<InputRecord, std::vector<std::byte>> found;
  StateReader in(records);
  while (in.ok() && !in.at_end()) {
    std::uint8_t kind = 0;
    std::uint32_t length = 0;
    in(kind, length);
    found[static_cast<InputRecord>(kind)].assign(in.rest().begin(), in.rest().begin() + length);
    in.skip(length);
  }
  StateReader of_trajectory(found[InputRecord::trajectory]);
  std::uint64_t id = 0;
  of_trajectory(id);
  auto trajectory = read_trajectory(of_trajectory);
  ASSERT_TRUE(trajectory.has_value());
  const auto shared = std::make_shared<const Trajectory>(*std::move(trajectory));
  const auto other = std::make_unique<Engine>(watchdog_, EngineCapacity{.robots = 4});
  TickReader& ticks = other->subscribe("other");
  const auto restored = other->restore(
      found[InputRecord::start], {.chain = [](std::uint64_t) { return std::shared_ptr<const kinematics::Chain>(); },
                                  .trajectory = [&](std::uint64_t wanted) { return wanted == id ? shared : nullptr; },
                                  .device = {}});
  ASSERT_TRUE(restored.has_value()) << restored.error().text();
  now_ = now_ - kPeriod;  // the start state is of before the last tick
  std::uint64_t cycle = cycle_ - 1;
  Timestamp now = now_;
  run_cycles(*other, now, cycle, 101);
  now_ = now_ + kPeriod;
  tick(100);
  EXPECT_EQ(now, now_);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(robot().joints[i].position, ticks.newest().robots[0].joints[i].position);
  EXPECT_TRUE(ticks.newest().robots[0].trajectory.moving);
  const auto without = std::make_unique<Engine>(watchdog_, EngineCapacity{.robots = 4});
  EXPECT_FALSE(without->restore(found[InputRecord::start], {.chain = {}, .trajectory = {}, .device = {}}).has_value());
}

}  // namespace
}  // namespace cellmirror::engine
