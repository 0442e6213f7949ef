#include "rt_core/motion/planner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "arms.hpp"
#include "rt_core/kinematics/forward.hpp"
#include "rt_core/motion/move_text.hpp"

namespace cellmirror::motion {
namespace {

using test_arms::puma;
using test_arms::puma_posture;
using testing::HasSubstr;

RobotParameters with_speeds() {
  RobotParameters p;
  p.max_velocity.fill(2.0);
  p.active_velocity.fill(1.0);
  p.max_acceleration.fill(3.0);
  p.active_acceleration.fill(4.0);
  return p;
}

TEST(PlanJointMove, TakesTheSmallerOfTheActiveAndTheMaximumValue) {
  RobotParameters p = with_speeds();
  p.active_velocity[1] = 5.0;
  const Move move = plan_joint_move(puma(), p, puma_posture()).value();
  EXPECT_EQ(move.velocity[0], 1.0);
  EXPECT_EQ(move.velocity[1], 2.0);
  EXPECT_EQ(move.acceleration[0], 3.0);
  EXPECT_EQ(move.max_velocity[0], 2.0);
}

TEST(PlanJointMove, HasSensibleSpeedsWhereNoneWereSet) {
  const Move move = plan_joint_move(puma(), RobotParameters{}, puma_posture()).value();
  EXPECT_EQ(move.velocity[0], 1.0);
  EXPECT_EQ(move.max_velocity[0], 1.0);
  EXPECT_EQ(move.acceleration[0], 4.0);
  EXPECT_TRUE(is_sound(move, 6));
  RobotParameters p;
  p.max_velocity.fill(3.0);
  EXPECT_EQ(plan_joint_move(puma(), p, puma_posture()).value().velocity[0], 3.0);
  EXPECT_EQ(plan_joint_move(test_arms::gantry(), RobotParameters{}, {}).value().velocity[0], 0.1);
}

TEST(PlanJointMove, RefusesTargetsBeyondTheRangeAndNamesTheJoint) {
  JointValues target = puma_posture();
  target[4] = 1.75;
  const auto refused = plan_joint_move(puma(), with_speeds(), target);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().text(), HasSubstr("joint 5 (j5) would be at 100.268 deg"));
  target[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(plan_joint_move(puma(), with_speeds(), target).error().text(), HasSubstr("joint 5 (j5)"));
}

TEST(PlanJointMove, DurationIsThatOfTheSlowestAxis) {
  RobotParameters p = with_speeds();
  p.active_acceleration.fill(2.0);
  JointValues target = puma_posture();
  target[0] += 1.0;
  target[3] += 0.1;
  for (const PtpMode mode : {PtpMode::synchronous, PtpMode::asynchronous}) {
    p.ptp_mode = mode;
    EXPECT_NEAR(duration_of(plan_joint_move(puma(), p, target).value(), puma_posture(), 6), 1.5, 1e-12);
  }
}

TEST(PlanLinearMove, TellsHowFarALineGoesAndThatAPtpMoveMayDo) {
  const kinematics::Chain chain = puma();
  const JointValues from = puma_posture();
  Pose to = kinematics::forward(chain, std::span(from).first(6));
  to.translation().x() += 2.0;
  const auto refused = plan_linear_move(chain, with_speeds(), from, to);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().text(), HasSubstr("of 2000.0 mm only: "));
  EXPECT_THAT(refused.error().remedy, HasSubstr("PTP"));
}

TEST(PlanLinearMove, RefusesWhatIsNoPoseAndAStartThatIsNowhere) {
  const kinematics::Chain chain = puma();
  JointValues from = puma_posture();
  Pose to = kinematics::forward(chain, std::span(from).first(6));
  Pose broken = to;
  broken.translation().y() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(plan_linear_move(chain, with_speeds(), from, broken));
  from[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(plan_linear_move(chain, with_speeds(), from, to).error().text(), HasSubstr("joint 3 (j3)"));
}

TEST(PlanLinearMove, SpeedsThatAreNoNumbersBecomeTheDefaults) {
  RobotParameters p = with_speeds();
  p.linear_velocity = std::numeric_limits<double>::quiet_NaN();
  p.linear_acceleration = 0;
  const kinematics::Chain chain = puma();
  const JointValues from = puma_posture();
  const auto plan = plan_linear_move(chain, p, from, kinematics::forward(chain, std::span(from).first(6)));
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->move.linear_velocity, 1.0);
  EXPECT_EQ(plan->move.linear_acceleration, 2.0);
  EXPECT_EQ(plan->duration_s, 0.0);
  EXPECT_TRUE(is_sound(plan->move, 6));
}

TEST(MoveText, IsOneStableLineForEachKind) {
  Move move;
  move.id = 7;
  move.target = {0.5, -1e-9};
  move.velocity = {1, 2};
  move.acceleration = {4, 8};
  move.max_velocity = {3, 3};
  EXPECT_EQ(move_text(move, 2),
            "7 now joints sync sine target [0.500000 0.000000] velocity [1.000000 2.000000] "
            "acceleration [4.000000 8.000000] max [3.000000 3.000000]");
  move.kind = MoveKind::delay;
  move.start = Start::queue;
  move.delay_s = 0.25;
  EXPECT_EQ(move_text(move, 2), "7 queued delay 0.250000");
  move.kind = MoveKind::linear;
  move.profile = VelocityProfile::ramp;
  move.X_BG.translation() = Eigen::Vector3d(0.1, -0.2, 0.3);
  move.X_BG.linear() = Eigen::AngleAxisd(-std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  move.task.position_axes = 0b101;
  move.task.orientation = kinematics::OrientationTask::approach;
  move.linear_velocity = 1.2;
  move.linear_acceleration = 4.8;
  move.rotational_velocity = 3;
  move.rotational_acceleration = 6;
  move.fly_parameter = 0.005;
  EXPECT_EQ(move_text(move, 2),
            "7 queued linear ramp to [0.100000 -0.200000 0.300000 1.000000 0.000000 0.000000 0.000000] task xz/a "
            "linear 1.200000 4.800000 rotational 3.000000 6.000000 fly distance 0.005000 "
            "max [3.000000 3.000000] min [0.000000 0.000000]");
}

}  // namespace
}  // namespace cellmirror::motion
