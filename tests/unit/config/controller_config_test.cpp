// [[controller]] and [dds] in cell files: ROS 2 controllers of robots.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/cell_file.hpp"
#include "tests/unit/config/temporary_home.hpp"
#include "tests/unit/config/two_joint_arm.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;

struct ControllerConfigTest : testing::Test {
  ControllerConfigTest() { home.write("envlib/arm.mpc", kTwoJointArm); }
  std::optional<LoadedCell> load(const std::string& tables) {
    diagnostics = {};
    return load_cell(home.write("cell.toml",
                                "format = 1\nname = \"c\"\n[[node]]\nname = \"Arm\"\nabstract = "
                                "\"arm.mpc\"\n" +
                                    tables),
                     diagnostics);
  }
  TemporaryHome home;
  Diagnostics diagnostics;
};

TEST_F(ControllerConfigTest, AControllerHasAllJointsByDefault) {
  const auto cell = load("[[controller]]\nrobot = \"ARM\"\nname = \"/arm_controller\"\n");
  ASSERT_TRUE(cell) << diagnostics.text();
  ASSERT_EQ(cell->controllers.size(), 1U);
  const ControllerConfig& one = cell->controllers[0];
  EXPECT_EQ(one.robot, "ARM");
  EXPECT_EQ(one.name, "arm_controller");
  EXPECT_EQ(one.interface_address, "127.0.0.1");
  EXPECT_FALSE(one.allow_partial);
  EXPECT_EQ(one.distribution, RosDistribution::jazzy);
  ASSERT_EQ(one.joints.size(), 2U);
  EXPECT_EQ(one.joints[1].ros_name, "J_2");
}

TEST_F(ControllerConfigTest, ReadsAllKeys) {
  const auto cell = load(R"([dds]
ros_distribution = "humble"
node_name = "my_cell"
[[controller]]
robot = "ARM"
name = "left/arm_controller"
domain = 7
interface_address = "127.0.0.1"
goal_time_s = 0.5
stopped_velocity = 0.02
allow_partial_joints = true
state_rate_hz = 20
[[controller.joint]]
joint = "J_2"
ros_name = "lift"
path_tolerance_m = 0.1
goal_tolerance_m = 0.01
)");
  ASSERT_TRUE(cell) << diagnostics.text();
  const ControllerConfig& one = cell->controllers.at(0);
  EXPECT_EQ(one.name, "left/arm_controller");
  EXPECT_EQ(one.domain, 7);
  EXPECT_EQ(one.goal_time, 0.5);
  EXPECT_EQ(one.stopped_velocity, 0.02);
  EXPECT_TRUE(one.allow_partial);
  EXPECT_EQ(one.state_rate_hz, 20);
  EXPECT_EQ(one.distribution, RosDistribution::humble);
  ASSERT_EQ(one.joints.size(), 1U);
  EXPECT_EQ(one.joints[0].joint, 1U);
  EXPECT_EQ(one.joints[0].ros_name, "lift");
  EXPECT_EQ(one.joints[0].path_tolerance, 0.1);
  EXPECT_EQ(cell->ros.distribution, RosDistribution::humble);
  EXPECT_EQ(cell->ros.node_name, "my_cell");
}

TEST_F(ControllerConfigTest, RefusesWhatCannotWork) {
  EXPECT_FALSE(load("[[controller]]\nrobot = \"ARN\"\nname = \"/a\"\n"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("no robot ARN"));
  EXPECT_FALSE(load("[[controller]]\nrobot = \"ARM\"\n"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("name"));
  EXPECT_FALSE(load("[[controller]]\nrobot = \"ARM\"\nname = \"/a b\"\n"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("not a name of ROS 2"));
  EXPECT_FALSE(
      load("[[controller]]\nrobot = \"ARM\"\nname = \"/a\"\n[[controller]]\nrobot = \"ARM\"\nname = \"/b\"\n"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("another controller"));
  EXPECT_FALSE(
      load("[[controller]]\nrobot = \"ARM\"\nname = \"/a\"\n[[controller.joint]]\njoint = \"J_2\"\n"
           "path_tolerance_rad = 1\n"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("path_tolerance_rad"));
  EXPECT_FALSE(
      load("[[controller]]\nrobot = \"ARM\"\nname = \"/a\"\n[[controller.joint]]\njoint = \"J_1\"\n"
           "[[controller.joint]]\njoint = \"J_1\"\n"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("twice"));
  EXPECT_FALSE(load("[dds]\nros_distribution = \"bouncy\"\n"));
  EXPECT_FALSE(load("[dds]\nnode_name = \"1st\"\n"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("name of a node"));
}

}  // namespace
}  // namespace cellmirror
