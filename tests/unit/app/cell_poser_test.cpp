// What a worker sees of the cell and of the tick.
#include "app/snapshot/cell_poser.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "app/owner/sensing.hpp"
#include "tests/unit/cell/cell_from_text.hpp"

namespace cellmirror::app {
namespace {

constexpr const char* kNodes = R"(
[[node]]
name = "Arm"
abstract = "arm.mpc"
[[node]]
name = "Box"
geometry = [{ box_m = [1, 1, 1] }]
[[node]]
name = "Ear"
type = "sensor"
[[node]]
name = "Cam"
type = "camera"
)";

struct CellFollowerTest : testing::Test {
  CellFollowerTest() {
    auto files = std::make_shared<TextFiles>();
    files->add("arm.mpc", kArm);
    Diagnostics diagnostics;
    cell = build_cell(kNodes, files, diagnostics);
    EXPECT_TRUE(cell) << diagnostics.text();
    engine::RobotTickState& robot = tick.robots[cell->robot("ARM")->slot()];
    robot.mode = engine::RobotMode::simulated;
    robot.joint_count = static_cast<std::uint8_t>(cell->robot("ARM")->joints().size());
  }
  engine::RobotTickState& robot() { return tick.robots[cell->robot("ARM")->slot()]; }
  std::optional<Cell> cell;
  engine::TickState tick{8};
  CellPoser sut{false};
  CellPoser with_sensors{true};
};

TEST_F(CellFollowerTest, TakesOnlyChangesThatMatter) {
  EXPECT_TRUE(sut.take_cell(cell->compile()));
  EXPECT_TRUE(with_sensors.take_cell(cell->compile()));
  EXPECT_FALSE(sut.take_cell(cell->compile()));
  const auto kept = sut.cell();
  ASSERT_TRUE(cell->set_camera("Cam", 3.0, 0.4));
  EXPECT_FALSE(sut.take_cell(cell->compile()));
  EXPECT_EQ(sut.cell(), kept) << "so that what was computed for it stays valid";
  ASSERT_TRUE(cell->set_sensor_active("Ear", true));
  EXPECT_FALSE(sut.differs(cell->compile()));
  EXPECT_FALSE(sut.take_cell(cell->compile()));
  EXPECT_TRUE(with_sensors.take_cell(cell->compile()));
  ASSERT_TRUE(cell->set_placement("Box", pose_from_xyz_rpy({1, 2, 3}, {0, 0, 0})));
  EXPECT_TRUE(sut.differs(cell->compile()));
  EXPECT_TRUE(sut.take_cell(cell->compile()));
  ASSERT_TRUE(cell->connect("Box", "Arm.TIP", cell->start_positions()));
  EXPECT_TRUE(sut.take_cell(cell->compile()));
}

TEST_F(CellFollowerTest, TakesToolCentrePointsWhereTheyMatter) {
  CellPoser with_tools{false, true};
  ASSERT_TRUE(sut.take_cell(cell->compile()));
  ASSERT_TRUE(with_tools.take_cell(cell->compile()));
  ASSERT_TRUE(cell->set_camera("Cam", 3.0, 0.4));
  EXPECT_FALSE(with_tools.take_cell(cell->compile()));
  const Pose X_PT = pose_from_xyz_rpy({0, 0, 0.02}, {0, 0, 0});
  ASSERT_TRUE(cell->edit_robot("ARM")->set_tool_center_point(X_PT));
  EXPECT_FALSE(sut.take_cell(cell->compile()));
  EXPECT_TRUE(with_tools.take_cell(cell->compile()));
  EXPECT_EQ(with_tools.cell()->robots.front().X_FT.matrix(), X_PT.matrix());
  EXPECT_FALSE(with_tools.take_cell(cell->compile()));
}

TEST_F(CellFollowerTest, WaitsForRobotsThatTheTickDoesNotKnowYet) {
  ASSERT_TRUE(sut.take_cell(cell->compile()));
  robot().mode = engine::RobotMode::absent;
  EXPECT_FALSE(sut.take_posture(tick));
  robot().mode = engine::RobotMode::simulated;
  EXPECT_TRUE(sut.take_posture(tick));
  robot().joint_count -= 1;
  EXPECT_FALSE(sut.take_posture(tick)) << "the slot still holds the robot before";
}

TEST_F(CellFollowerTest, TellsWhereThingsWillBeAtPresentVelocities) {
  ASSERT_TRUE(sut.take_cell(cell->compile()));
  robot().joints[0].position = 0.5;  // LIFT, m
  ASSERT_TRUE(sut.take_posture(tick));
  EXPECT_EQ(sut.later(tick, Nanoseconds(10'000'000)), nullptr) << "nothing moves";
  robot().joints[0].velocity = 2.0;
  const auto node = static_cast<std::size_t>(sut.cell()->robots.front().flange);
  const CellPoses* later = sut.later(tick, Nanoseconds(10'000'000));
  ASSERT_NE(later, nullptr);
  EXPECT_NEAR((later->X_WN[node].translation() - sut.poses().X_WN[node].translation()).z(), 0.02, 1e-12);
  robot().mode = engine::RobotMode::mirrored;
  robot().state = DataState::stale;
  EXPECT_EQ(sut.later(tick, Nanoseconds(10'000'000)), nullptr) << "the velocity is not known any more";
  robot().state = DataState::fresh;
  EXPECT_NE(sut.later(tick, Nanoseconds(10'000'000)), nullptr);
}

struct CellSensingTest : CellFollowerTest {
  std::optional<CellSensing> sensing;
  CellSensingTest() {
    collision::Settings settings;
    settings.rules = {{"Box", "Arm.LIFT.TURN", collision::PairRule::Kind::ignore, "of the file"}};
    sensing.emplace(*cell, settings);
  }
};

TEST_F(CellSensingTest, SettingsAreReplacedAsAWhole) {
  const auto before = sensing->collision();
  ASSERT_TRUE(sensing->set_collision_active(true));
  EXPECT_EQ(sensing->collision(), before) << "nothing changed";
  ASSERT_TRUE(sensing->set_collision_active(false));
  ASSERT_TRUE(sensing->set_collision_warning(0.2));
  EXPECT_TRUE(before->active);
  EXPECT_FALSE(sensing->collision()->active);
  EXPECT_EQ(sensing->collision()->warning_distance_m, 0.2);
  ASSERT_TRUE(sensing->set_range_send_mode(RangeSendMode::one_message_for_all));
  EXPECT_EQ(sensing->send_mode(), RangeSendMode::one_message_for_all);
}

TEST_F(CellSensingTest, ANewRuleTakesThePlaceOfTheOldOneForThesePathsInEitherOrder) {
  using Kind = collision::PairRule::Kind;
  ASSERT_TRUE(sensing->set_collision_pair("Ear", "Arm.TIP", PairTreatment::ignore));
  ASSERT_TRUE(sensing->set_collision_pair("Arm.TURN", "Box", PairTreatment::test));
  auto rules = sensing->collision()->rules;
  ASSERT_EQ(rules.size(), 2U);
  EXPECT_EQ(rules[1].a, "Arm.LIFT.TURN") << "as a full path";
  EXPECT_EQ(rules[1].b, "Box");
  EXPECT_EQ(rules[1].kind, Kind::test);
  ASSERT_TRUE(sensing->set_collision_pair("Box", "Arm.TURN", PairTreatment::derive));
  EXPECT_EQ(sensing->collision()->rules.size(), 1U);
  EXPECT_FALSE(sensing->set_collision_pair("Boxx", "Arm.TURN", PairTreatment::test));
  EXPECT_EQ(sensing->collision()->rules.size(), 1U);
}

TEST_F(CellSensingTest, SensorsAreChangedInTheCell) {
  ASSERT_TRUE(sensing->set_sensor_active("Ear", true));
  ASSERT_TRUE(sensing->set_sensor_range("Ear", 1.25));
  EXPECT_TRUE(cell->compile()->sensors.front().sensor.active);
  EXPECT_EQ(cell->compile()->sensors.front().sensor.range_m, 1.25);
  EXPECT_FALSE(sensing->set_sensor_range("Ear", -1.0));
  EXPECT_FALSE(sensing->set_sensor_active("Cam", true));
}

}  // namespace
}  // namespace cellmirror::app
