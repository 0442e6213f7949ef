#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "app/new_cell/cell_text.hpp"
#include "app/new_cell/signal_source.hpp"
#include "app/new_cell/simulation_text.hpp"

namespace cellmirror::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

GuessedSignals guess(const std::string& text) {
  Diagnostics diagnostics;
  return guess_signals(can::parse_dbc(text, "a.dbc", diagnostics));
}

TEST(SignalGuess, TakesPositionsByNameAndUnitAndTheirVelocities) {
  const GuessedSignals sut = guess(
      "BO_ 1 Axis0_Get_Encoder_Estimates: 8 A\n SG_ Pos_Estimate : 0|32@1- (1,0) [0|0] \"rev\" M\n"
      " SG_ Vel_Estimate : 32|32@1- (1,0) [0|0] \"rev/s\" M\n"
      "BO_ 2 Axis1_Get_Encoder_Estimates: 8 A\n SG_ Pos_Estimate : 0|32@1- (1,0) [0|0] \"rev\" M\n"
      " SG_ Vel_Estimate : 32|32@1- (1,0) [0|0] \"rev/s\" M\n"
      "BO_ 3 Axis0_Heartbeat: 8 A\n SG_ Axis_State : 0|8@1+ (1,0) [0|0] \"\" M\n");
  EXPECT_EQ(sut.joints, 2U);
  ASSERT_EQ(sut.signals.size(), 4U);
  EXPECT_EQ(sut.signals[1].message, "Axis1_Get_Encoder_Estimates");
  EXPECT_EQ(sut.signals[1].joint, 1U);
  EXPECT_DOUBLE_EQ(sut.signals[0].scale, 2 * std::numbers::pi);
  EXPECT_EQ(sut.signals[3].quantity, JointQuantity::velocity);
  EXPECT_EQ(sut.signals[3].joint, 1U) << "of its own message";
  EXPECT_THAT(sut.others, ElementsAre("Axis0_Heartbeat.Axis_State []"));
}

TEST(SignalGuess, LeavesOutWhatIsCommandedLimitedOrCounted) {
  const GuessedSignals sut = guess(
      "BO_ 1 ControlCmd: 8 A\n SG_ Position_64 : 0|16@1- (0.01,0) [0|0] \"deg\" M\n"
      "BO_ 2 Status: 8 A\n SG_ PositionLimit : 0|16@1- (0.01,0) [0|0] \"deg\" M\n"
      " SG_ TargetAngle : 16|16@1- (0.01,0) [0|0] \"deg\" M\n SG_ AverageRadius : 32|8@1+ (1,0) [0|0] \"m\" M\n"
      " SG_ Height : 40|8@1+ (1,0) [0|0] \"mm\" M\n SG_ PositionVolts : 48|8@1+ (1,0) [0|0] \"V\" M\n");
  EXPECT_EQ(sut.joints, 0U);
  EXPECT_TRUE(sut.signals.empty());
  EXPECT_EQ(sut.others.size(), 6U);
}

TEST(SignalGuess, NeverTakesMoreJointsThanARobotHas) {
  std::string text = "BO_ 1 M: 64 A\n";
  for (int i = 0; i < 30; ++i)
    text += " SG_ Pos" + std::to_string(i) + " : " + std::to_string(16 * i) + "|16@1- (1,0) [0|0] \"rad\" M\n";
  EXPECT_EQ(guess(text).joints, 16U);
}

CellPlan plan_of(PlannedRobot robot) {
  CellPlan plan;
  plan.name = "mine";
  plan.channel = "socketcan:can0";
  plan.robots.push_back(std::move(robot));
  return plan;
}

TEST(Simulation, IsLeftOutWithAReasonWhereItWouldMislead) {
  PlannedRobot robot;
  robot.node = "Axis";
  robot.joints = made_up_joints(2);
  robot.drives = {{.node = 3, .joint = 0, .increments = 10, .default_mapping = false}};
  EXPECT_THAT(simulation_of(plan_of(robot), robot).why, HasSubstr("another TPDO"));
  robot.drives[0].default_mapping = true;
  EXPECT_THAT(simulation_of(plan_of(robot), robot).words, testing::Contains("3"));
  robot.drives.clear();
  robot.signals = {{.message = "M", .signal = "A", .joint = 0, .scale = 1},
                   {.message = "M", .signal = "B", .joint = 1, .scale = 2}};
  EXPECT_THAT(simulation_of(plan_of(robot), robot).why, HasSubstr("scales"));
}

TEST(Simulation, MovesEachJointWithinItsRangeAndSlowlyEnough) {
  PlannedRobot robot;
  robot.joints = {{"up", JointKind::revolute, -3, -1, -2, 0.1},
                  {"end", JointKind::prismatic, 0, 0.05, 0.05, 1},
                  {"free", JointKind::continuous, 0, 0, 0, 0}};
  EXPECT_EQ(motion_text(robot),
            "time_s, q1, q2, q3\n0.0, -2.0000, 0.0500, 0.0000\n30.0, -1.6000, 0.0300, 0.4000\n60.0, -2.0000, 0.0500, "
            "0.0000\n");
}

}  // namespace
}  // namespace cellmirror::app
