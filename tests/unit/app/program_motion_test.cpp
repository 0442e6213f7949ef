// The moves of robot programs on the transfer cell: the gateway's own desk and fleet, and the tick, driven by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "app/owner/fleet.hpp"
#include "app/owner/motion/motion_service.hpp"
#include "app/owner/programs/move_settings.hpp"
#include "app/owner/programs/program_motion.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/motion/planner.hpp"
#include "rt_core/rt/watchdog.hpp"
#include "tests/unit/app/transfer_cell.hpp"

namespace cellmirror::app {
namespace {

using program::MotionProgress;
using program::MoveCommand;
using program::PathKind;
using program::Target;
using program::TargetKind;

constexpr Nanoseconds kPeriod{1'000'000};
constexpr std::string_view kRobot = "PUMA_762";

class ProgramMotionTest : public testing::Test {
 protected:
  ProgramMotionTest() {
    EXPECT_TRUE(fleet_.follow_cell());
    tick();
    RobotParameters& p = settings_;
    p = cell_.robot(kRobot)->parameters();
    std::copy_n(fleet_.positions()[cell_.robot(kRobot)->slot()].begin(), start_.size(), start_.begin());
  }

  void tick(int count = 1) {
    for (int i = 0; i < count; ++i) {
      clock_.advance(kPeriod);
      CycleContext context;
      context.now = context.scheduled = clock_.now();
      context.cycle = cycle_++;
      context.period = kPeriod;
      engine_->run(context);
      motion_.follow();
    }
  }
  MotionProgress run(int most = 60'000) {
    do {
      tick();
    } while (sut_.progress(kRobot).moving && most-- > 0);
    EXPECT_GT(most, 0);
    return sut_.progress(kRobot);
  }

  static MoveCommand joints(TargetKind kind, const JointValues& values, std::uint8_t count) {
    MoveCommand command;
    command.target.kind = kind;
    command.target.joints = values;
    command.target.joint_count = count;
    return command;
  }
  static MoveCommand pose(PathKind path, TargetKind kind, const Pose& X) {
    MoveCommand command;
    command.path = path;
    command.target.kind = kind;
    command.target.pose = X;
    return command;
  }
  static Pose shift(double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); }

  [[nodiscard]] Eigen::Vector3d tcp() const { return sut_.position(kRobot)->translation(); }
  // Away from the singular posture of the start.
  void bend() {
    ASSERT_TRUE(sut_.move(kRobot, joints(TargetKind::joints_relative, {0.2, -0.3, 0.4, 0.2, 0.5, 0.1}, 6), {}));
    run();
  }

  Cell cell_ = transfer_cell();
  ManualClock clock_;
  Watchdog watchdog_{std::chrono::seconds(1), {}};
  std::unique_ptr<engine::Engine> engine_ = std::make_unique<engine::Engine>(watchdog_);
  Fleet fleet_{cell_, *engine_, {}, clock_, 0};
  NoNames names_;
  MotionService motion_{cell_, names_, [] { return Eigen::Matrix3d::Identity().eval(); }, fleet_, clock_};
  CellProgramMotion sut_{cell_, motion_, fleet_, clock_};
  RobotParameters settings_;
  JointValues start_{};
  std::uint64_t cycle_ = 0;
};

TEST_F(ProgramMotionTest, JointsGoToOrByTheirValuesAndTheOthersStay) {
  ASSERT_TRUE(sut_.check(kRobot));
  const auto first = sut_.move(kRobot, joints(TargetKind::joints_relative, {0.1, -0.2}, 2), {});
  ASSERT_TRUE(first) << first.error().text();
  // Planned from where the one before ends, while that has not begun.
  const auto second = sut_.move(kRobot, joints(TargetKind::joints_relative, {0.1}, 1), {});
  ASSERT_TRUE(second);
  EXPECT_EQ(*second, *first + 1);
  EXPECT_TRUE(sut_.progress(kRobot).moving);
  const MotionProgress progress = run();
  EXPECT_EQ(progress.finished, *second);
  EXPECT_EQ(progress.end, MotionProgress::End::arrived);
  EXPECT_FALSE(progress.moving);
  const JointValues q = sut_.joints(kRobot);
  EXPECT_NEAR(q[0], start_[0] + 0.2, 1e-9);
  EXPECT_NEAR(q[1], start_[1] - 0.2, 1e-9);
  EXPECT_NEAR(q[2], start_[2], 1e-12);
  ASSERT_TRUE(sut_.move(kRobot, joints(TargetKind::joints_absolute, start_, 6), {}));
  run();
  EXPECT_NEAR(sut_.joints(kRobot)[0], start_[0], 1e-9);
  EXPECT_EQ(sut_.joint_kinds(kRobot).size(), 6U);
}

TEST_F(ProgramMotionTest, PosesAreInTheZeroPointRelativeToTheEndOfTheMoveBeforeOrInTheTool) {
  bend();
  const Pose X = *sut_.position(kRobot);
  ASSERT_TRUE(sut_.move(kRobot, pose(PathKind::linear, TargetKind::pose_relative, shift(0, 0, -0.05)), {}));
  ASSERT_TRUE(sut_.move(kRobot, pose(PathKind::linear, TargetKind::pose_relative, shift(0.03, 0, 0)), {}));
  run();
  EXPECT_NEAR((tcp() - X.translation() - Eigen::Vector3d(0.03, 0, -0.05)).norm(), 0, 1e-8);
  ASSERT_TRUE(sut_.move(kRobot, pose(PathKind::linear, TargetKind::tool_relative, shift(0, 0, -0.04)), {}));
  run();
  EXPECT_NEAR((tcp() - X.translation() - Eigen::Vector3d(0.03, 0, -0.05) + 0.04 * X.linear().col(2)).norm(), 0, 1e-8);
  ASSERT_TRUE(sut_.move(kRobot, pose(PathKind::joints, TargetKind::pose_absolute, X), {}));
  const MotionProgress progress = run();
  EXPECT_EQ(progress.end, MotionProgress::End::arrived);
  EXPECT_NEAR((tcp() - X.translation()).norm(), 0, 1e-4);
}

TEST_F(ProgramMotionTest, ArcGoesThroughItsViaPoint) {
  bend();
  const Eigen::Vector3d from = tcp();
  MoveCommand arc = pose(PathKind::circular, TargetKind::pose_relative, shift(0, -0.1, 0));
  EXPECT_FALSE(sut_.move(kRobot, arc, {}));
  arc.via = Target{.kind = TargetKind::pose_relative, .pose = shift(0, -0.05, -0.05)};
  const auto moved = sut_.move(kRobot, arc, {});
  ASSERT_TRUE(moved) << moved.error().text();
  const Eigen::Vector3d centre = from + Eigen::Vector3d(0, -0.05, 0);
  double off = 0;
  while (sut_.progress(kRobot).moving) {
    tick();
    off = std::max(off, std::abs((tcp() - centre).norm() - 0.05));
  }
  EXPECT_LT(off, 2e-6);
  EXPECT_NEAR((tcp() - from - Eigen::Vector3d(0, -0.1, 0)).norm(), 0, 1e-8);
}

TEST_F(ProgramMotionTest, TimesOfMovesAndDelaysAddUpWithTheInstantOfTheBeginning) {
  bend();
  const Timestamp begin = clock_.now();
  tick(7);
  double expected = 0;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(sut_.delay(kRobot, 0.1234, i == 0 ? begin : Timestamp()));
    MoveCommand command = joints(TargetKind::joints_relative, {i % 2 == 0 ? 0.3 : -0.3}, 1);
    command.settings.joint_velocity = 0.5;
    command.settings.joint_acceleration = 0.5;
    ASSERT_TRUE(sut_.move(kRobot, command, {}));
    const double velocity = 0.5 * settings_.max_velocity[0];
    const double acceleration =
        0.5 * (settings_.max_acceleration[0] > 0 ? settings_.max_acceleration[0]
                                                 : settings_.max_velocity[0] / motion::kDefaultRampSeconds);
    const bool cruises = 0.3 > velocity * velocity / acceleration;
    expected += 0.1234 + (cruises ? 0.3 / velocity + velocity / acceleration : 2 * std::sqrt(0.3 / acceleration));
  }
  const MotionProgress progress = run();
  EXPECT_NEAR(seconds(progress.finished_time - begin), expected, 1e-7);
}

TEST_F(ProgramMotionTest, ToolOfAProgramIsItsOwn) {
  bend();
  const Pose X = *sut_.position(kRobot);
  const Pose X_PT = settings_.X_PT * shift(0, 0, 0.1);
  ASSERT_TRUE(sut_.set_tool(kRobot, X_PT));
  EXPECT_NEAR((sut_.position(kRobot)->translation() - X.translation() - 0.1 * X.linear().col(2)).norm(), 0, 1e-12);
  // The tip goes to where the other one was.
  ASSERT_TRUE(sut_.move(kRobot, pose(PathKind::linear, TargetKind::pose_absolute, X), {}));
  run();
  EXPECT_NEAR((tcp() - X.translation()).norm(), 0, 1e-8);
  ASSERT_TRUE(sut_.set_tool(kRobot, std::nullopt));
  EXPECT_NEAR((tcp() - X.translation() + 0.1 * X.linear().col(2)).norm(), 0, 1e-8);
  EXPECT_TRUE(cell_.robot(kRobot)->parameters().X_PT.isApprox(settings_.X_PT));
  // Tools that change between moves that wait: each goes with its own.
  ASSERT_TRUE(sut_.move(kRobot, pose(PathKind::linear, TargetKind::pose_absolute, X), {}));
  ASSERT_TRUE(sut_.set_tool(kRobot, X_PT));
  ASSERT_TRUE(sut_.move(kRobot, pose(PathKind::linear, TargetKind::pose_relative, shift(0, -0.02, 0)), {}));
  ASSERT_TRUE(sut_.set_tool(kRobot, std::nullopt));
  const MotionProgress progress = run();
  EXPECT_EQ(progress.end, MotionProgress::End::arrived);
  EXPECT_NEAR((tcp() - X.translation() - Eigen::Vector3d(0, -0.02, 0)).norm(), 0, 1e-8);
}

TEST_F(ProgramMotionTest, HoldResumeAndStop) {
  ASSERT_TRUE(sut_.move(kRobot, joints(TargetKind::joints_relative, {0.5}, 1), {}));
  ASSERT_TRUE(sut_.move(kRobot, joints(TargetKind::joints_relative, {-0.5}, 1), {}));
  tick(50);
  ASSERT_TRUE(sut_.set_pace(kRobot, 0));
  tick(2000);
  EXPECT_EQ(sut_.progress(kRobot).pace, 0);
  EXPECT_TRUE(sut_.progress(kRobot).moving);
  const JointValues held = sut_.joints(kRobot);
  tick(100);
  EXPECT_EQ(sut_.joints(kRobot), held);
  ASSERT_TRUE(sut_.set_pace(kRobot, 1));
  tick(20);
  EXPECT_NE(sut_.joints(kRobot), held);
  ASSERT_TRUE(sut_.set_pace(kRobot, 0));
  tick(2000);
  ASSERT_TRUE(sut_.stop(kRobot));
  tick(2);
  const MotionProgress progress = sut_.progress(kRobot);
  EXPECT_EQ(progress.finished, 2U);
  EXPECT_EQ(progress.end, MotionProgress::End::stopped);
  EXPECT_FALSE(progress.moving);
  // A hold of a robot that stands is ended as well, and the next move begins where it stands.
  ASSERT_TRUE(sut_.set_pace(kRobot, 0));
  tick();
  ASSERT_TRUE(sut_.stop(kRobot));
  const double stands = sut_.joints(kRobot)[0];
  ASSERT_TRUE(sut_.move(kRobot, joints(TargetKind::joints_relative, {0.1}, 1), {}));
  run();
  EXPECT_NEAR(sut_.joints(kRobot)[0], stands + 0.1, 1e-9);
}

TEST_F(ProgramMotionTest, WhatCannotBeDoneIsRefusedAndMovesNothing) {
  bend();
  const auto refused = [&](const MoveCommand& command) {
    const auto moved = sut_.move(kRobot, command, {});
    return moved ? std::string("accepted") : moved.error().text();
  };
  EXPECT_NE(refused(joints(TargetKind::joints_absolute, {99}, 1)).find("beyond its range"), std::string::npos);
  EXPECT_NE(refused(joints(TargetKind::joints_absolute, {}, 7)).find("has 6 joints"), std::string::npos);
  EXPECT_NE(refused(pose(PathKind::linear, TargetKind::pose_relative, shift(9, 0, 0))).find("straight line"),
            std::string::npos);
  EXPECT_NE(refused(pose(PathKind::joints, TargetKind::pose_absolute, shift(9, 0, 0))), "accepted");
  EXPECT_NE(refused(pose(PathKind::joints, TargetKind::pose_absolute, shift(std::nan(""), 0, 0))).find("finite"),
            std::string::npos);
  MoveCommand fast = joints(TargetKind::joints_relative, {0.1}, 1);
  fast.settings.joint_velocity = 1.5;
  EXPECT_NE(refused(fast).find("maximum velocity"), std::string::npos);
  EXPECT_FALSE(sut_.delay(kRobot, -1, {}));
  EXPECT_FALSE(sut_.delay(kRobot, std::nan(""), {}));
  EXPECT_FALSE(sut_.check("NOBODY"));
  EXPECT_FALSE(sut_.move("NOBODY", fast, {}));
  EXPECT_FALSE(sut_.delay("NOBODY", 1, {}));
  EXPECT_FALSE(sut_.stop("NOBODY"));
  EXPECT_FALSE(sut_.set_pace("NOBODY", 0));
  EXPECT_FALSE(sut_.set_tool("NOBODY", {}));
  EXPECT_FALSE(sut_.room("NOBODY"));
  EXPECT_FALSE(sut_.position("NOBODY"));
  EXPECT_TRUE(sut_.joint_kinds("NOBODY").empty());
  EXPECT_FALSE(sut_.progress(kRobot).moving);
}

TEST_F(ProgramMotionTest, RobotThatWasDeletedIsRefusedBeforeTheTickHasLetGoOfItToo) {
  ASSERT_TRUE(sut_.move(kRobot, joints(TargetKind::joints_relative, {0.1}, 1), {}));
  tick(5);
  ASSERT_TRUE(cell_.delete_node("Puma"));
  EXPECT_FALSE(sut_.stop(kRobot));
  EXPECT_FALSE(sut_.delay(kRobot, 1, {}));
  EXPECT_FALSE(sut_.move(kRobot, joints(TargetKind::joints_relative, {0.1}, 1), {}));
  EXPECT_FALSE(sut_.room(kRobot));
  EXPECT_FALSE(sut_.progress(kRobot).moving);
  motion_.follow_cell();
  ASSERT_TRUE(fleet_.follow_cell());
  tick();
  EXPECT_FALSE(sut_.stop(kRobot));
}

TEST_F(ProgramMotionTest, QueueHasRoomForAsManyMovesAsTheTickTakes) {
  std::size_t given = 0;
  while (sut_.room(kRobot) && given < 1000) {
    ASSERT_TRUE(sut_.delay(kRobot, 0.001, {}));
    ++given;
  }
  EXPECT_EQ(given, motion::kMoveQueue);
  run();
  EXPECT_TRUE(sut_.room(kRobot));
  EXPECT_EQ(sut_.progress(kRobot).end, MotionProgress::End::arrived);
}

TEST(MoveSettings, TakeThePlaceOfTheRobotsOwnWhichStayTheUpperBounds) {
  RobotParameters robot;
  robot.max_velocity = {2.0, 0.0, 0.0};
  robot.active_velocity = {0.3, 0.3, 0.3};
  robot.max_acceleration = {8.0};
  robot.linear_velocity = 1.0;
  robot.velocity_scale = 0.5;
  robot.fly_type = FlyType::angle;
  robot.fly_parameter = 0.2;
  constexpr JointKind kKinds[] = {JointKind::revolute, JointKind::revolute, JointKind::prismatic};
  MoveCommand command;
  auto sut = parameters_for(robot, kKinds, command);
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->active_velocity[0], 0.3);
  EXPECT_EQ(sut->linear_velocity * sut->velocity_scale, 0.5);
  EXPECT_EQ(sut->fly_parameter, 0);  // it does not fly
  command.fly = true;
  command.settings.joint_velocity = 0.5;
  command.settings.joint_acceleration = 0.25;
  command.settings.linear_velocity = 0.4;
  command.settings.rotational_velocity = 99;
  sut = parameters_for(robot, kKinds, command);
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->active_velocity[0], 1.0);
  EXPECT_EQ(sut->active_velocity[1], 0.5 * motion::kDefaultTurning);
  EXPECT_EQ(sut->active_velocity[2], 0.5 * motion::kDefaultSliding);
  EXPECT_EQ(sut->active_acceleration[0], 2.0);
  EXPECT_EQ(sut->active_acceleration[2], 0.25 * motion::kDefaultSliding / motion::kDefaultRampSeconds);
  EXPECT_EQ(sut->linear_velocity, 0.4);
  EXPECT_EQ(sut->rotational_velocity, 0.5 * robot.rotational_velocity);
  EXPECT_EQ(sut->fly_type, FlyType::angle);
  EXPECT_EQ(sut->fly_parameter, 0.2);
  command.settings.fly_type = FlyType::distance;
  command.settings.fly_parameter = 0.01;
  sut = parameters_for(robot, kKinds, command);
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->fly_type, FlyType::distance);
  EXPECT_EQ(sut->fly_parameter, 0.01);
  MoveCommand shares;
  shares.settings.linear_velocity_share = 0.5;
  shares.settings.rotational_acceleration_share = 0.25;
  sut = parameters_for(robot, kKinds, shares);
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->linear_velocity, 0.25);
  EXPECT_EQ(sut->rotational_acceleration, 0.25 * robot.rotational_acceleration);
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    MoveCommand wrong;
    wrong.settings.linear_velocity = bad;
    EXPECT_FALSE(parameters_for(robot, kKinds, wrong)) << bad;
    wrong.settings = {};
    wrong.settings.linear_velocity_share = bad;
    EXPECT_FALSE(parameters_for(robot, kKinds, wrong)) << bad;
    wrong.settings = {};
    wrong.settings.joint_acceleration = bad;
    EXPECT_FALSE(parameters_for(robot, kKinds, wrong)) << bad;
  }
}

// The robot of a program is deleted first, then the program ends.
TEST_F(ProgramMotionTest, ARobotThatIsLoadedAgainDoesNotHaveTheToolOfAProgramFromBefore) {
  const Eigen::Vector3d own = tcp();
  ASSERT_TRUE(sut_.set_tool(kRobot, shift(0, 0, 0.3)));
  ASSERT_GT((tcp() - own).norm(), 0.1);
  Cell with_robot = std::exchange(cell_, transfer_cell());
  ASSERT_TRUE(cell_.delete_node("Puma"));
  EXPECT_FALSE(sut_.set_tool(kRobot, std::nullopt));
  cell_ = std::move(with_robot);
  EXPECT_NEAR((tcp() - own).norm(), 0, 1e-9);
}

}  // namespace
}  // namespace cellmirror::app
