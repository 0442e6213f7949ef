#include "rt_core/dynamics/robot_mechanism.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "rt_core/dynamics/inverse_dynamics.hpp"
#include "tests/unit/cell/cell_from_text.hpp"

namespace cellmirror::dynamics {
namespace {

using Eigen::Vector3d;

constexpr double kGravity = 9.80665;

// A lift (z) that carries a turning arm (about y), with the hand TIP 1 m beyond in x.
constexpr const char* kCrane = R"(
body = { mass_kg = 500.0 }  # stands still
[[node]]
name = "LIFT"
body = { mass_kg = 10.0 }
[node.joint]
type = "prismatic"
axis = [0, 0, 1]
range_m = [0.0, 2.0]
velocity_m_s = 1.5
effort_n = 400.0
viscous_friction_n_s_m = 3.0
[[node]]
name = "BEND"
parent = "LIFT"
xyz_m = [1.0, 0.0, 0.0]
joint = { type = "revolute", axis = [0, 1, 0], range_rad = [-2.0, 1.0], velocity_rad_s = 2.0 }
[[node]]
name = "BRACKET"
parent = "BEND"
xyz_m = [0.5, 0.0, 0.0]
body = { mass_kg = 4.0, center_m = [0.1, 0.0, 0.0] }
[[node]]
name = "TIP"
parent = "BEND"
xyz_m = [1.0, 0.0, 0.0]
[robot]
id = "CRANE"
flange = "TIP"
)";

Cell cell_of(const std::string& nodes, const std::map<std::string, std::string>& parts) {
  auto files = std::make_shared<TextFiles>();
  files->add("crane.mpc", kCrane);
  for (const auto& [name, text] : parts) files->add(name, text);
  Diagnostics diagnostics;
  auto cell = build_cell(nodes, files, diagnostics);
  if (!cell) throw std::runtime_error(diagnostics.text());
  return std::move(*cell);
}

Cell crane_and_weight() {
  return cell_of(R"(
[[node]]
name = "Crane"
abstract = "crane.mpc"
[[node]]
name = "Weight"
xyz_m = [2.0, 0.0, 0.0]
abstract = "weight.mpc"
)",
                 {{"weight.mpc", "body = { mass_kg = 7.0 }\n"}});
}

RobotMechanism mechanism_of(const Cell& cell, std::string_view id = "CRANE") {
  const auto compiled = cell.compile();
  for (auto& mechanism : robot_mechanisms(*compiled)) {
    if (mechanism.slot == cell.robot(id)->slot()) return mechanism;
  }
  throw std::runtime_error("no such robot");
}

std::vector<double> holding(const RobotMechanism& robot, std::vector<double> qdd = {}) {
  const std::vector<double> zero(robot.variables.size(), 0.0);
  qdd.resize(zero.size());
  DynamicsOutput output;
  inverse_dynamics(*robot.mechanism, {zero, zero, qdd}, output);
  return {output.effort.begin(), output.effort.begin() + static_cast<std::ptrdiff_t>(zero.size())};
}

TEST(RobotMechanism, holdsWhatItsJointsMove) {
  const RobotMechanism sut = mechanism_of(crane_and_weight());
  ASSERT_TRUE(sut.mechanism) << sut.why_not;
  EXPECT_EQ(sut.model_kg, 14.0);
  EXPECT_EQ(sut.payload_kg, 0.0);
  EXPECT_EQ(sut.joint_links, (std::vector<std::int32_t>{0, 1}));
  EXPECT_EQ(sut.mechanism->tip_link(), 1);
  EXPECT_TRUE(sut.mechanism->X_LT().translation().isApprox(Vector3d(1, 0, 0)));
  EXPECT_EQ(sut.mechanism->drive(0).max_effort, 400.0);
  EXPECT_EQ(sut.mechanism->drive(0).viscous_friction, 3.0);
  const auto effort = holding(sut);
  EXPECT_NEAR(effort[0], 14.0 * kGravity, 1e-12);
  EXPECT_NEAR(effort[1], -4.0 * 0.6 * kGravity, 1e-12);  // about y, from x towards -z
}

TEST(RobotMechanism, bearsWhatIsConnected) {
  Cell cell = crane_and_weight();
  const auto before = cell.compile();
  ASSERT_TRUE(cell.connect("Weight", "TIP", cell.start_positions()));
  EXPECT_FALSE(same_masses(*before, *cell.compile()));
  const RobotMechanism sut = mechanism_of(cell);
  EXPECT_EQ(sut.model_kg, 14.0);
  EXPECT_EQ(sut.payload_kg, 7.0);
  EXPECT_NEAR(holding(sut)[1], -(4.0 * 0.6 + 7.0 * 1.0) * kGravity, 1e-12);
  // Hidden: not there. Shown again: there.
  ASSERT_TRUE(cell.deactivate("Weight"));
  EXPECT_EQ(mechanism_of(cell).payload_kg, 0.0);
  ASSERT_TRUE(cell.activate("Weight"));
  EXPECT_EQ(mechanism_of(cell).payload_kg, 7.0);
}

TEST(RobotMechanism, staysWhereOnlyOtherThingsChange) {
  Cell cell = crane_and_weight();
  const auto before = cell.compile();
  const std::vector<double> velocity{1.0, 1.0};
  ASSERT_TRUE(cell.edit_robot("CRANE")->set_joint_parameter(JointParameter::max_velocity, velocity));
  const auto after = cell.compile();
  EXPECT_NE(before, after);
  EXPECT_TRUE(same_masses(*before, *after));
  Pose X_FT = Pose::Identity();
  X_FT.translation().z() = 0.2;
  ASSERT_TRUE(cell.edit_robot("CRANE")->set_tool_center_point(X_FT));
  EXPECT_FALSE(same_masses(*before, *cell.compile()));
}

TEST(RobotMechanism, isNoneWithoutMassesInTheModel) {
  Cell cell = cell_of(R"(
[[node]]
name = "Arm"
abstract = "arm.mpc"
[[node]]
name = "Weight"
abstract = "weight.mpc"
)",
                      {{"arm.mpc", kArm}, {"weight.mpc", "body = { mass_kg = 7.0 }\n"}});
  ASSERT_TRUE(cell.connect("Weight", "TIP", cell.start_positions()));
  const RobotMechanism sut = mechanism_of(cell, "ARM");
  EXPECT_FALSE(sut.mechanism);
  EXPECT_EQ(sut.model_kg, 0.0);
  EXPECT_EQ(sut.why_not, "");
}

// A crane that hangs on another's tip: each feels the other's motion.
TEST(RobotMechanism, countsRobotsOnRobots) {
  Cell cell = cell_of(R"(
[[node]]
name = "Lower"
abstract = "crane.mpc"
[[node]]
name = "Upper"
xyz_m = [2.0, 0.0, 0.0]
abstract = "crane.mpc"
robot_id = "UPPER"
)",
                      {});
  ASSERT_TRUE(cell.connect("Upper", "Lower.LIFT.BEND.TIP", cell.start_positions()));
  const RobotMechanism lower = mechanism_of(cell);
  const RobotMechanism upper = mechanism_of(cell, "UPPER");
  ASSERT_TRUE(lower.mechanism) << lower.why_not;
  ASSERT_TRUE(upper.mechanism) << upper.why_not;
  EXPECT_EQ(lower.model_kg, 14.0);
  EXPECT_EQ(lower.payload_kg, 514.0);  // its base too
  EXPECT_EQ(upper.payload_kg, 0.0);
  ASSERT_EQ(lower.variables.size(), 4U);
  ASSERT_EQ(upper.variables.size(), 4U);
  EXPECT_NE(upper.variables[0].slot, upper.variables[2].slot);
  // The upper robot's own lift is its first variable; the lower's lift accelerates it as well.
  EXPECT_NEAR(holding(upper)[0], 14.0 * kGravity, 1e-9);
  EXPECT_NEAR(holding(upper, {0, 0, 2.0})[0], 14.0 * (kGravity + 2.0), 1e-9);
  EXPECT_NEAR(holding(lower)[0], 528.0 * kGravity, 1e-9);
  EXPECT_NEAR(holding(lower, {0, 0, 2.0})[0], 528.0 * kGravity + 2.0 * 14.0, 1e-9);
}

}  // namespace
}  // namespace cellmirror::dynamics
