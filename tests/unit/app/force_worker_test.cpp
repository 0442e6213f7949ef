// The forces of a cell at one tick after the other, and what becomes of them.
#include "app/workers/force_worker.hpp"
#include "app/workers/robot_motions.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "app/io/publisher.hpp"
#include "app/owner/robot_force_service.hpp"
#include "app/owner/tcp_force_service.hpp"
#include "app/report/status_forces.hpp"
#include "app/subcommands/status_table_forces.hpp"
#include "app/workers/robot_force_writer.hpp"
#include "rt_core/dynamics/arrows.hpp"
#include "tests/unit/cell/cell_from_text.hpp"

namespace cellmirror::app {
namespace {

constexpr double kG = 9.80665;

// A lift of 10 kg that can bear 150 N, and an arm without masses.
constexpr const char* kLift = R"(
[[node]]
name = "LIFT"
body = { mass_kg = 10.0 }
[node.joint]
type = "prismatic"
axis = [0, 0, 1]
range_m = [0.0, 2.0]
velocity_m_s = 1.5
effort_n = 150.0
[[node]]
name = "TOP"
parent = "LIFT"
xyz_m = [0.0, 0.0, 0.5]
[robot]
id = "LIFTER"
flange = "TOP"
)";

struct ForceComputationTest : testing::Test {
  ForceComputationTest() {
    auto files = std::make_shared<TextFiles>();
    files->add("lift.mpc", kLift);
    files->add("arm.mpc", kArm);
    files->add("weight.mpc", "body = { mass_kg = 7.0 }\n");
    Diagnostics diagnostics;
    cell = build_cell(R"(
[[node]]
name = "Lift"
abstract = "lift.mpc"
[[node]]
name = "Arm"
abstract = "arm.mpc"
[[node]]
name = "Weight"
abstract = "weight.mpc"
)",
                      files, diagnostics);
    EXPECT_TRUE(cell) << diagnostics.text();
    tick.time = Timestamp{1'000'000'000};
    for (const char* id : {"LIFTER", "ARM"}) {
      engine::RobotTickState& robot = tick.robots[cell->robot(id)->slot()];
      robot.mode = engine::RobotMode::simulated;
      robot.joint_count = static_cast<std::uint8_t>(cell->robot(id)->joints().size());
    }
    take_cell();
  }
  bool take_cell() {
    compiled = cell->compile();
    return sut.take_cell(compiled);
  }
  engine::RobotTickState& lift() { return tick.robots[cell->robot("LIFTER")->slot()]; }
  const RobotForces& computed() {
    EXPECT_TRUE(read_motions(*compiled, tick, motions));
    sut.compute(tick.time, motions, tick.haptics, &loads, state);
    return state.robots.at(0);
  }
  void next(std::int64_t ms) { tick.time = tick.time + Nanoseconds(ms * 1'000'000); }

  std::optional<Cell> cell;
  engine::TickState tick{8};
  ForceState state;
  InstrumentLoads loads;
  std::shared_ptr<const CompiledCell> compiled;
  std::vector<dynamics::RobotMotion> motions;
  dynamics::ForceComputation sut{Eigen::Vector3d(0, 0, -kG)};
};

TEST_F(ForceComputationTest, TellsOfRobotsWithMasses) {
  lift().joints[0].position = 0.25;
  const RobotForces& forces = computed();
  ASSERT_EQ(state.robots.size(), 1U);
  EXPECT_TRUE(sut.has_mechanisms());
  EXPECT_EQ(forces.id, "LIFTER");
  EXPECT_EQ(forces.model_kg, 10.0);
  ASSERT_EQ(forces.joints.size(), 1U);
  EXPECT_NEAR(forces.joints[0].effort, 10.0 * kG, 1e-12);
  EXPECT_EQ(forces.joints[0].max_effort, 150.0);
  EXPECT_FALSE(forces.joints[0].beyond_limit);
  EXPECT_NEAR(forces.joints[0].X_WJ.translation().z(), 0.25, 1e-12);
  EXPECT_NEAR(forces.X_WT.translation().z(), 0.75, 1e-12);
  EXPECT_TRUE(forces.tcp_known);
  EXPECT_EQ(forces.tcp_T.force.norm(), 0.0) << "it holds nothing";
}

TEST_F(ForceComputationTest, CountsLimitsThatArePassedOnce) {
  ASSERT_TRUE(cell->connect("Weight", "TOP", cell->start_positions()));
  EXPECT_TRUE(take_cell());
  EXPECT_EQ(computed().payload_kg, 7.0);
  EXPECT_TRUE(state.robots[0].joints[0].beyond_limit);
  next(1);
  computed();
  EXPECT_EQ(sut.limit_warnings(), 1U);
  ASSERT_TRUE(cell->deactivate("Weight"));
  take_cell();
  EXPECT_FALSE(computed().joints[0].beyond_limit);
  ASSERT_TRUE(cell->activate("Weight"));
  take_cell();
  computed();
  EXPECT_EQ(sut.limit_warnings(), 2U);
}

// A weight of 7 kg beside the tip: its force and its moment about the tip, at rest and while the lift accelerates.
TEST_F(ForceComputationTest, GivesTheForceOfWhatTheRobotHoldsAtTheTcp) {
  Pose X_PN = Pose::Identity();
  X_PN.translation() = Eigen::Vector3d(0.3, 0, 0.5);
  ASSERT_TRUE(cell->set_placement("Weight", X_PN));
  ASSERT_TRUE(cell->connect("Weight", "TOP", cell->start_positions()));
  take_cell();
  EXPECT_TRUE(computed().tcp_T.force.isApprox(Eigen::Vector3d(0, 0, -7.0 * kG), 1e-12));
  EXPECT_TRUE(state.robots[0].tcp_T.torque.isApprox(Eigen::Vector3d(0, 0.3 * 7.0 * kG, 0), 1e-12));
  ForceArrowSettings settings;
  settings.tcp_force = ArrowComponent::resultant;
  const auto arrows = dynamics::force_arrows(settings, state);
  ASSERT_EQ(arrows.size(), 1U);
  EXPECT_NEAR(arrows[0].from_m.z(), 0.5, 1e-12);
  EXPECT_NEAR(arrows[0].vector.z(), -7.0 * kG, 1e-12);
  for (int i = 0; i < 200; ++i, next(1)) {
    lift().joints[0].velocity = 2.0 * 1e-3 * i;
    computed();
  }
  EXPECT_NEAR(state.robots[0].tcp_T.force.z(), -7.0 * (kG + 2.0), 1e-2);
}

TEST_F(ForceComputationTest, DerivesAccelerationsOfMoves) {
  for (int i = 0; i < 200; ++i, next(1)) {
    lift().joints[0].velocity = 2.0 * 1e-3 * i;
    computed();
  }
  EXPECT_NEAR(state.robots[0].joints[0].acceleration, 2.0, 1e-3);
  EXPECT_NEAR(state.robots[0].joints[0].effort, 10.0 * (kG + 2.0), 1e-2);
}

// A mirrored robot whose data is too old stands still as far as anybody knows.
TEST_F(ForceComputationTest, TakesAMirroredRobotWithOldDataForStanding) {
  lift().mode = engine::RobotMode::mirrored;
  lift().state = DataState::fresh;
  for (int i = 0; i < 50; ++i, next(10)) {
    lift().receive_time = tick.time;
    lift().joints[0].position = 0.01 * i;
    computed();
  }
  EXPECT_NEAR(state.robots[0].joints[0].velocity, 1.0, 1e-2) << "from positions: no velocities are sent";
  lift().state = DataState::stale;
  EXPECT_EQ(computed().joints[0].velocity, 0.0);
  EXPECT_NEAR(state.robots[0].joints[0].effort, 10.0 * kG, 1e-12);
}

TEST_F(ForceComputationTest, TakesTheForceAtTheTipOfAnInstrument) {
  tick.haptics[1].phase = HapticPhase::active;
  tick.haptics[1].slot = static_cast<std::uint8_t>(cell->robot("LIFTER")->slot());
  tick.haptics[1].force_E = Eigen::Vector3d(0, 0, -20);
  tick.haptics[1].axis_torque = 0.5;
  EXPECT_TRUE(computed().tcp_known);
  EXPECT_NEAR(state.robots[0].joints[0].effort, 10.0 * kG + 20.0, 1e-12);
  EXPECT_EQ(state.robots[0].tcp_T.torque.z(), 0.5);
  // A robot without masses is told of too, without efforts.
  tick.haptics[1].slot = static_cast<std::uint8_t>(cell->robot("ARM")->slot());
  computed();
  ASSERT_EQ(state.robots.size(), 2U);
  const RobotForces& arm = state.robots[cell->robot("ARM")->slot() < cell->robot("LIFTER")->slot() ? 0 : 1];
  EXPECT_FALSE(arm.computed);
  EXPECT_TRUE(arm.joints.empty());
  EXPECT_EQ(arm.tcp_T.force.z(), -20.0);
  EXPECT_NEAR(arm.X_WT.translation().x(), 3.0, 1e-12);
}

struct WrittenForces final : RobotForceChannel {
  void write(const Eigen::Vector3d& force_T, std::span<const double> torques) override {
    force = force_T;
    efforts.assign(torques.begin(), torques.end());
  }
  Eigen::Vector3d force = Eigen::Vector3d::Constant(99);
  std::vector<double> efforts{99};
};

TEST_F(ForceComputationTest, TakesTheForceOfTissueOnARobotThatNoDeviceMoves) {
  loads.posture_time = tick.time;
  loads.loads = {{.slot = static_cast<std::uint8_t>(cell->robot("LIFTER")->slot()),
                  .force_T = Eigen::Vector3d(0, 0, -20),
                  .torque_T = Eigen::Vector3d(0, 0, 0.5)}};
  EXPECT_NEAR(computed().joints[0].effort, 10.0 * kG + 20.0, 1e-12);
  EXPECT_EQ(state.robots[0].tcp_T.force.z(), -20.0);
  // The force of a haptic device takes precedence.
  tick.haptics[1].phase = HapticPhase::active;
  tick.haptics[1].slot = static_cast<std::uint8_t>(cell->robot("LIFTER")->slot());
  tick.haptics[1].force_E = Eigen::Vector3d(0, 0, -3);
  EXPECT_NEAR(computed().joints[0].effort, 10.0 * kG + 3.0, 1e-12);
  tick.haptics[1].phase = HapticPhase::closed;
  next(1000);
  EXPECT_NEAR(computed().joints[0].effort, 10.0 * kG, 1e-12) << "the load is too old";
}

// Three axes, each 1 m after the other: linear along z, revolute about z, revolute about y. The TCP is 1 m beyond the
// last axis, at x = 3.
TEST_F(ForceComputationTest, GivesTheLoadOfTissueToTheJointsOfARobotWithoutMasses) {
  loads.posture_time = tick.time;
  loads.loads = {{.slot = static_cast<std::uint8_t>(cell->robot("ARM")->slot()),
                  .force_T = Eigen::Vector3d(0, 5, 2),
                  .torque_T = Eigen::Vector3d(0, 0.25, 0)}};
  computed();
  const auto arm = std::ranges::find(state.robots, "ARM", &RobotForces::id);
  ASSERT_NE(arm, state.robots.end());
  EXPECT_FALSE(arm->computed);
  ASSERT_EQ(arm->joints.size(), 3U);
  EXPECT_NEAR(arm->joints[0].effort, -2.0, 1e-12);
  EXPECT_NEAR(arm->joints[1].effort, -2.0 * 5.0, 1e-12);        // 2 m from its axis
  EXPECT_NEAR(arm->joints[2].effort, 1.0 * 2.0 - 0.25, 1e-12);  // 1 m along x
  const auto written = std::make_shared<WrittenForces>();
  CellState cell_state;
  cell_state.robot_forces.push_back({.robot = "ARM", .channel = written});
  write_robot_forces(cell_state, tick, state);
  EXPECT_EQ(written->force, Eigen::Vector3d(0, 5, 2));
  ASSERT_EQ(written->efforts.size(), 3U);
  EXPECT_NEAR(written->efforts[1], 10.0, 1e-12);
}

TEST_F(ForceComputationTest, GoesIntoThePlainBuffersOfRobots) {
  ASSERT_TRUE(cell->connect("Weight", "TOP", cell->start_positions()));
  take_cell();
  computed();
  const auto lifter = std::make_shared<WrittenForces>();
  const auto arm = std::make_shared<WrittenForces>();
  const auto nobody = std::make_shared<WrittenForces>();
  CellState cell_state;
  for (const auto& [robot, channel] : {std::pair("LIFTER", lifter), std::pair("ARM", arm), std::pair("GONE", nobody)})
    cell_state.robot_forces.push_back({.robot = robot, .channel = channel});
  write_robot_forces(cell_state, tick, state);
  EXPECT_NEAR(lifter->force.z(), -7.0 * kG, 1e-12);
  ASSERT_EQ(lifter->efforts.size(), 1U);
  EXPECT_NEAR(lifter->efforts[0], 17.0 * kG, 1e-12);
  for (const auto& unknown : {arm, nobody}) {
    EXPECT_EQ(unknown->force, Eigen::Vector3d(0, 0, 0));
    EXPECT_TRUE(unknown->efforts.empty());
  }
  // Contacts of a device take the place of what is computed.
  HapticSnapshot device;
  device.robot = "ARM";
  device.channel = 1;
  cell_state.haptics.push_back(device);
  tick.haptics[1].phase = HapticPhase::active;
  tick.haptics[1].slot = static_cast<std::uint8_t>(cell->robot("ARM")->slot());
  tick.haptics[1].force_E = Eigen::Vector3d(1, 2, 3);
  tick.haptics[1].joint_torques[0] = 0.5;
  write_robot_forces(cell_state, tick, state);
  EXPECT_EQ(arm->force, Eigen::Vector3d(1, 2, 3));
  ASSERT_EQ(arm->efforts.size(), cell->robot("ARM")->joints().size());
  EXPECT_EQ(arm->efforts[0], 0.5);
}

TEST_F(ForceComputationTest, NamesTheTorquesThatABufferHasNoRoomFor) {
  const CompiledRobot& lifter = *compiled->robot(cell->robot("LIFTER")->slot());
  EXPECT_EQ(force_memory_remark(*compiled, lifter, 16), "");
  EXPECT_EQ(force_memory_remark(*compiled, lifter, 15),
            "15 bytes hold the force and 0 of 1 joint torques; there is no room for LIFT: 16 bytes hold all");
  const CompiledRobot& arm = *compiled->robot(cell->robot("ARM")->slot());
  EXPECT_EQ(
      force_memory_remark(*compiled, arm, 500),
      "the model of ARM has no masses, so its values are zero unless a haptic device moves it or it touches tissue");
}

TEST_F(ForceComputationTest, WaitsForRobotsThatTheTickDoesNotKnowYet) {
  lift().mode = engine::RobotMode::absent;
  EXPECT_FALSE(read_motions(*compiled, tick, motions));
}

// What is computed goes out as the effort of robots that nobody measures.
TEST_F(ForceComputationTest, GivesEffortsToRobotStates) {
  computed();
  std::vector<RobotState> robots(2);
  robots[0].id = robots[1].id = "LIFTER";
  robots[0].joints.resize(1);
  robots[1].joints.resize(1);
  robots[1].online = true;
  robots[1].joints[0].effort = 5.0;
  take_efforts(state, robots);
  EXPECT_NEAR(robots[0].joints[0].effort, 10.0 * kG, 1e-12);
  EXPECT_EQ(robots[1].joints[0].effort, 5.0) << "measured";
}

TEST_F(ForceComputationTest, IsToldInStatus) {
  computed();
  ForceReport report;
  report.active = true;
  report.gravity_m_s2 = Eigen::Vector3d(0, 0, -kG);
  report.state = std::make_shared<const ForceState>(state);
  report.not_computed = {{"BIG", "too many joints"}};
  ForceSettings settings;
  settings.arrows.joint_forces = ArrowComponent::resultant;
  const nlohmann::json status = {{"forces", forces_json(report, settings, tick.time + Nanoseconds(1'000'000))}};
  const nlohmann::json& forces = status.at("forces");
  EXPECT_NEAR(forces.at("robots").at(0).at("joints").at(0).at("effort_n").get<double>(), 10.0 * kG, 1e-9);
  EXPECT_EQ(forces.at("robots").at(0).at("joints").at(0).at("max_effort_n"), 150.0);
  EXPECT_EQ(forces.at("robots").at(0).at("tcp").at("force_n").at(2), 0.0);
  EXPECT_EQ(forces.at("arrows").at("shown").size(), 1U);
  EXPECT_EQ(forces.at("arrows").at("joint_forces"), "resultant");
  EXPECT_NEAR(forces.at("age_s").get<double>(), 1e-3, 1e-9);
  const std::string text = forces_table(status);
  EXPECT_NE(text.find("LIFTER 10.0 kg: LIFT 98.1 N"), std::string::npos) << text;
  EXPECT_NE(text.find("BIG not computed: too many joints"), std::string::npos) << text;
  EXPECT_EQ(forces_table({{"forces", forces_json({}, {}, tick.time)}}), "");
  EXPECT_EQ(forces_table(nlohmann::json::object()), "");
}

TEST(UnseenArrows, AreToldWhereTheCellHasNothingToDraw) {
  CompiledCell cell;
  cell.parent = {-1, 0, 1, 0};
  cell.joint_of = {-1, 0, -1, -1};
  cell.inertia = {{.node = 3, .inertia = {}}};  // stands in the world
  ForceArrowSettings sut;
  EXPECT_EQ(arrows_without_effect(sut, cell, false), "");
  sut.joint_torques = ArrowComponent::resultant;
  EXPECT_EQ(arrows_without_effect(sut, cell, false),
            "no joint of the cell moves a part whose mass is known, so joints have no arrows");
  cell.inertia.push_back({.node = 2, .inertia = {}});  // behind the joint
  EXPECT_EQ(arrows_without_effect(sut, cell, false), "");
  sut.tcp_force = ArrowComponent::x;
  EXPECT_EQ(arrows_without_effect(sut, cell, false), "") << "of the robot with masses";
  cell.inertia.pop_back();
  EXPECT_EQ(arrows_without_effect(sut, cell, false),
            "no joint of the cell moves a part whose mass is known and there is no haptic device, so joints and TCPs "
            "have no arrows");
  EXPECT_EQ(arrows_without_effect(sut, cell, true),
            "no joint of the cell moves a part whose mass is known, so joints have no arrows");
  sut.joint_torques = ArrowComponent::none;
  EXPECT_EQ(arrows_without_effect(sut, cell, true), "");
}

}  // namespace
}  // namespace cellmirror::app
