#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "tests/unit/cell/cell_from_text.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
using Values = std::vector<double>;

// Three joints: LIFT 0..2 m at 1.5 m/s, TURN -3..3 rad, BEND -2..1 rad at 2 rad/s.
struct Robot : testing::Test {
  Robot() {
    files->add("arm.mpc", kArm);
    Diagnostics diagnostics;
    cell = build_cell("[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n", files, diagnostics);
    EXPECT_TRUE(cell) << diagnostics.text();
    sut = cell->edit_robot("ARM");
  }
  std::string set(JointParameter which, const Values& values) {
    const auto result = sut->set_joint_parameter(which, values);
    return result ? "" : result.error().what;
  }
  std::shared_ptr<TextFiles> files = std::make_shared<TextFiles>();
  std::optional<Cell> cell;
  RobotModel* sut = nullptr;
};

TEST_F(Robot, hasItsJointsInTheOrderOfTheFile) {
  EXPECT_EQ(sut->joint_names(), (std::vector<std::string>{"LIFT", "TURN", "BEND"}));
  EXPECT_EQ(sut->joint_kinds()[0], JointKind::prismatic);
  EXPECT_EQ(sut->parameters().max_range[0], 2.0);
  EXPECT_EQ(sut->parameters().active_velocity[1], 2.0) << "as fast as it may, by default";
}

TEST_F(Robot, takesTheManualsExamplesForAThreeAxisRobot) {
  EXPECT_EQ(set(JointParameter::min_velocity, {8.5e-3, 3.14159E-04, 4.014257E-04}), "");
  EXPECT_EQ(set(JointParameter::active_velocity, {1.3, 1.9, 1.5707963}), "");
}

TEST_F(Robot, refusesAnotherCountThanItsJoints) {
  EXPECT_THAT(set(JointParameter::max_velocity, {1.0, 1.0}), HasSubstr("ARM has 3 joints, but 2 values"));
  EXPECT_THAT(set(JointParameter::max_velocity, Values(7, 1.0)), HasSubstr("7 values"));
  EXPECT_THAT(set(JointParameter::max_velocity, {}), HasSubstr("0 values"));
}

TEST_F(Robot, refusesConflictsAndChangesNothing) {
  const RobotParameters before = sut->parameters();
  EXPECT_THAT(set(JointParameter::max_range, {1.0, 1.0, -2.0}), HasSubstr("is not above its lower limit"));
  EXPECT_THAT(set(JointParameter::min_range, {-1.0, 3.5, -1.0}), HasSubstr("joint 2 (TURN)"));
  EXPECT_THAT(set(JointParameter::start_position, {0.0, 0.0, 1.5}), HasSubstr("is above its upper limit 1 rad"));
  EXPECT_THAT(set(JointParameter::max_velocity, {1.0, 0.0, 1.0}), HasSubstr("is not positive"));
  EXPECT_THAT(set(JointParameter::min_velocity, {0.0, -0.1, 0.0}), HasSubstr("is negative"));
  EXPECT_THAT(set(JointParameter::min_velocity, {0.0, 2.5, 0.0}), HasSubstr("is above its maximum velocity"));
  EXPECT_THAT(set(JointParameter::active_velocity, {1.6, 1.0, 1.0}), HasSubstr("1.6 m/s"));
  EXPECT_THAT(set(JointParameter::active_acceleration, {1.0, 1.0, 5.0}), HasSubstr("maximum acceleration"));
  EXPECT_THAT(set(JointParameter::max_acceleration, {1.0, kNaN, 5.0}), HasSubstr("not a number"));
  EXPECT_EQ(sut->parameters().max_range, before.max_range);
  EXPECT_EQ(sut->parameters().min_range, before.min_range);
  EXPECT_EQ(sut->parameters().max_velocity, before.max_velocity);
  EXPECT_EQ(sut->parameters().start_position, before.start_position);
}

TEST_F(Robot, aNarrowedLimitLimitsWhatIsInForceAndNotWhatWasRequested) {
  ASSERT_EQ(set(JointParameter::start_position, {1.5, 2.5, 0.0}), "");
  ASSERT_EQ(set(JointParameter::max_range, {1.0, 2.0, 1.0}), "");
  EXPECT_EQ(sut->parameters().start_position[0], 1.0);
  EXPECT_EQ(sut->parameters().start_position[1], 2.0);
  ASSERT_EQ(set(JointParameter::max_velocity, {0.5, 2.0, 2.0}), "");
  EXPECT_EQ(sut->parameters().active_velocity[0], 0.5);
  EXPECT_EQ(sut->parameters().requested.active_velocity[0], 1.5);
  EXPECT_EQ(sut->parameters().requested.start_position[0], 1.5);
  ASSERT_EQ(set(JointParameter::max_velocity, {1.5, 2.0, 2.0}), "");
  ASSERT_EQ(set(JointParameter::max_range, {2.0, 3.0, 1.0}), "");
  EXPECT_EQ(sut->parameters().active_velocity[0], 1.5);
  EXPECT_EQ(sut->parameters().start_position[0], 1.5);
  ASSERT_EQ(set(JointParameter::max_acceleration, {0.1, 0.1, 0.1}), "");
  ASSERT_EQ(set(JointParameter::max_acceleration, {4.0, 4.0, 4.0}), "");
  EXPECT_EQ(sut->parameters().active_acceleration, sut->parameters().requested.active_acceleration);
}

TEST_F(Robot, scalarsHaveTheirRanges) {
  EXPECT_TRUE(sut->set_scalar_parameter(ScalarParameter::linear_velocity, 1.2));
  EXPECT_EQ(sut->parameters().linear_velocity, 1.2);
  EXPECT_FALSE(sut->set_scalar_parameter(ScalarParameter::linear_velocity, 0.0));
  EXPECT_TRUE(sut->set_scalar_parameter(ScalarParameter::velocity_scale, 0.01));
  EXPECT_TRUE(sut->set_scalar_parameter(ScalarParameter::acceleration_scale, 1.0));
  EXPECT_FALSE(sut->set_scalar_parameter(ScalarParameter::velocity_scale, 0.009));
  EXPECT_FALSE(sut->set_scalar_parameter(ScalarParameter::acceleration_scale, 1.01));
  EXPECT_TRUE(sut->set_scalar_parameter(ScalarParameter::program_delay, 0.0));
  EXPECT_FALSE(sut->set_scalar_parameter(ScalarParameter::program_delay, -1.0));
  EXPECT_FALSE(sut->set_scalar_parameter(ScalarParameter::rotational_velocity, kNaN));
}

TEST_F(Robot, flyPointsHaveTheRangeOfTheirType) {
  EXPECT_TRUE(sut->set_fly(FlyType::speed_fraction, 1.0));
  EXPECT_FALSE(sut->set_fly(FlyType::speed_fraction, 1.1));
  EXPECT_TRUE(sut->set_fly(FlyType::distance, 0.005));
  EXPECT_FALSE(sut->set_fly(FlyType::distance, -0.005));
  EXPECT_FALSE(sut->set_fly(FlyType::angle, 4.0));
  EXPECT_EQ(sut->parameters().fly_type, FlyType::distance);
}

TEST_F(Robot, toolsMustBeFinite) {
  Pose X = Pose::Identity();
  X.translation().y() = kNaN;
  EXPECT_FALSE(sut->set_tool_center_point(X));
  X.translation().y() = 1e6;
  EXPECT_FALSE(sut->set_point_of_reference(X));
}

TEST_F(Robot, movesJointsWithinTheirLimitsAndLeavesTheOthers) {
  const JointValues current{0.5, 0.1, 0.2};
  const auto moved = sut->positions_to(Values{1.0, -1.0}, current);
  ASSERT_TRUE(moved);
  EXPECT_EQ((*moved)[0], 1.0);
  EXPECT_EQ((*moved)[1], -1.0);
  EXPECT_EQ((*moved)[2], 0.2);
  EXPECT_TRUE(sut->positions_to(Values{}, current));
}

TEST_F(Robot, refusesPositionsBeyondALimitNamingJointValueAndLimit) {
  const auto refused = sut->positions_to(Values{0.0, 0.0, std::numbers::pi / 2}, {});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("joint 3 (BEND) of ARM"));
  EXPECT_THAT(refused.error().what, HasSubstr("1.5708 rad (90 deg)"));
  EXPECT_THAT(refused.error().what, HasSubstr("upper limit 1 rad"));
  EXPECT_FALSE(sut->positions_to(Values{2.1}, {}));
  EXPECT_FALSE(sut->positions_to(Values{kNaN}, {}));
  EXPECT_THAT(sut->positions_to(Values(4, 0.0), {}).error().what, HasSubstr("4 values"));
}

TEST_F(Robot, incrementsAddToWhereTheRobotStands) {
  const JointValues current{1.9, 0.0, 0.0};
  const auto moved = sut->positions_by(Values{0.1, 0.2}, current);
  ASSERT_TRUE(moved);
  EXPECT_DOUBLE_EQ((*moved)[0], 2.0);
  EXPECT_FALSE(sut->positions_by(Values{0.2}, current));
  EXPECT_FALSE(sut->positions_by(Values(4, 0.0), current));
  const JointValues outside{2.5, 0.0, 0.0};
  EXPECT_TRUE(sut->positions_by(Values{0.0, 0.1}, outside)) << "what is not moved may stand beyond a limit";
}

TEST_F(Robot, slotsAreCounted) {
  Diagnostics diagnostics;
  std::string nodes;
  for (int i = 0; i < 257; ++i) {
    nodes += "[[node]]\nname = \"N" + std::to_string(i) + "\"\nabstract = \"arm.mpc\"\nrobot_id = \"R" +
             std::to_string(i) + "\"\n";
  }
  EXPECT_FALSE(build_cell(nodes, files, diagnostics));
  EXPECT_THAT(diagnostics.text(), HasSubstr("more than 256 robots"));
}

TEST_F(Robot, aRunningGatewayHasRoomForAFewMoreOnly) {
  Diagnostics diagnostics;
  auto full = build_cell(
      "[[node]]\nname = \"A\"\nabstract = \"arm.mpc\"\nrobot_id = \"R0\"\n"
      "[[node]]\nname = \"B\"\nabstract = \"arm.mpc\"\nrobot_id = \"R1\"\nloaded = false\nshown = \"hidden\"\n"
      "[[node]]\nname = \"C\"\nabstract = \"arm.mpc\"\nrobot_id = \"R2\"\nloaded = false\nshown = \"hidden\"\n",
      files, diagnostics);
  ASSERT_TRUE(full) << diagnostics.text();
  full->set_robot_capacity(2);
  ASSERT_TRUE(full->activate("B"));
  const auto refused = full->activate("C");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("more than 2 robots"));
  ASSERT_TRUE(full->delete_node("A"));
  ASSERT_TRUE(full->activate("C"));
  EXPECT_LT(full->robot("R2")->slot(), 2U) << "the slot of the robot that was deleted";
}

}  // namespace
}  // namespace cellmirror
