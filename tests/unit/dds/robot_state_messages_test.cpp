#include "drivers/dds/robot_state_messages.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace cellmirror::dds::test {
namespace {

RobotState robot(const std::string& id, const std::vector<std::string>& joints) {
  RobotState state;
  state.id = id;
  for (const std::string& name : joints) {
    RobotJointState joint;
    joint.name = name;
    joint.position = 1.0;
    state.joints.push_back(joint);
  }
  return state;
}

TEST(JointNames, ArePlainUntilTwoRobotsShareOne) {
  JointNames sut;
  const std::vector<RobotState> one = {robot("A", {"base", "hand"})};
  sut.see(one);
  sut.see(one);
  EXPECT_EQ(sut.name("A", "base"), "base");
  sut.see(std::vector<RobotState>{robot("B", {"base"})});
  EXPECT_EQ(sut.name("A", "base"), "A/base");
  EXPECT_EQ(sut.name("B", "base"), "B/base");
  EXPECT_EQ(sut.name("A", "hand"), "hand");
  sut.see(one);
  EXPECT_EQ(sut.name("A", "base"), "A/base") << "does not fall back";
}

TEST(JointStateOfRobots, LeavesOutWhatIsNotFinite) {
  std::vector<RobotState> robots = {robot("A", {"a", "b"})};
  robots[0].joints[0].velocity = std::numeric_limits<double>::infinity();
  JointNames names;
  names.see(robots);
  JointState message;
  EXPECT_EQ(fill_joint_state({1, 2}, robots, names, message), 1U);
  EXPECT_EQ(message.header.stamp, (RosTime{1, 2}));
  EXPECT_EQ(message.name, std::vector<std::string>{"b"});
  EXPECT_EQ(message.position.size(), 1U);
  EXPECT_EQ(message.velocity.size(), 1U);
  EXPECT_EQ(message.effort.size(), 1U);
}

TEST(TransformsOfFrames, CarryPositionAndUnitQuaternion) {
  const Pose X_PC = pose_from_xyz_rpy({1, 2, 3}, {std::numbers::pi, 0, 0});
  Pose broken = Pose::Identity();
  broken.translation().x() = std::numeric_limits<double>::quiet_NaN();
  const std::vector<FramePose> frames = {{"p", "broken", broken}, {"p", "c", X_PC}};
  TfMessage message;
  EXPECT_EQ(fill_transforms({3, 4}, frames, message), 1U);
  ASSERT_EQ(message.transforms.size(), 1U);
  EXPECT_EQ(message.transforms[0].header.frame_id, "p");
  EXPECT_EQ(message.transforms[0].child_frame_id, "c");
  EXPECT_EQ(message.transforms[0].translation, (std::array<double, 3>{1, 2, 3}));
  EXPECT_NEAR(std::abs(message.transforms[0].rotation[0]), 1.0, 1e-12);
}

}  // namespace
}  // namespace cellmirror::dds::test
