// The description of the robots as urdfdom, ROS's own reader, understands it.
#include "app/snapshot/robot_description.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <map>
#include <set>

#include "app/snapshot/robot_states.hpp"
#include "tests/unit/app/transfer_cell.hpp"

namespace cellmirror::app {
namespace {

using testing::HasSubstr;
using testing::Not;

struct RobotDescription : testing::Test {
  RobotDescription() : cell(transfer_cell()), compiled(cell.compile()), all(compiled->robots.size(), true) {}
  [[nodiscard]] urdf::ModelInterfaceSharedPtr read(const std::vector<bool>& wanted) const {
    auto model = urdf::parseURDF(robot_description(*compiled, wanted));
    EXPECT_TRUE(model);
    return model;
  }
  Cell cell;
  std::shared_ptr<const CompiledCell> compiled;
  std::vector<bool> all;
};

Pose pose_of(const urdf::Pose& X) {
  Pose out = Pose::Identity();
  out.linear() = Eigen::Quaterniond(X.rotation.w, X.rotation.x, X.rotation.y, X.rotation.z).toRotationMatrix();
  out.translation() = Eigen::Vector3d(X.position.x, X.position.y, X.position.z);
  return out;
}

// Of the link in the root, with joints as they stand.
Pose place_of(const urdf::ModelInterface& model, const std::string& name, const std::map<std::string, double>& q) {
  const auto link = model.getLink(name);
  if (!link->parent_joint) return Pose::Identity();
  const urdf::Joint& joint = *link->parent_joint;
  Pose X = place_of(model, joint.parent_link_name, q) * pose_of(joint.parent_to_joint_origin_transform);
  const Eigen::Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
  const auto position = q.find(name);
  if (position == q.end()) return X;
  if (joint.type == urdf::Joint::PRISMATIC) X.translate(axis * position->second);
  if (joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS)
    X.rotate(Eigen::AngleAxisd(position->second, axis));
  return X;
}

TEST_F(RobotDescription, HasEveryPublishedFrameWhereThatFrameIs) {
  const auto model = read(all);
  ASSERT_TRUE(model);
  EXPECT_EQ(model->getRoot()->name, "world");
  CellState state;
  state.cell = compiled;
  engine::TickState tick(compiled->robots.size());
  std::map<std::string, double> q;  // by child link
  for (const CompiledRobot& robot : compiled->robots) {
    engine::RobotTickState& its = tick.robots[robot.slot];
    its.mode = engine::RobotMode::simulated;
    its.joint_count = static_cast<std::uint8_t>(robot.joint_names.size());
    for (std::size_t j = 0; j < robot.joint_names.size(); ++j) {
      its.joints[j].position = 0.1 + 0.05 * static_cast<double>(j);
      q[robot.id + "/" + robot.joint_names[j]] = its.joints[j].position;
    }
  }
  RobotStateBuilder builder;
  static_cast<void>(builder.build(state, tick));
  std::map<std::string, Pose> frames{{"world", Pose::Identity()}};
  for (const FramePose& frame : builder.frames(state, all)) {
    frames[frame.child] = frames.at(frame.parent) * frame.X_PC;
    ASSERT_TRUE(model->getLink(frame.child)) << frame.child;
    const Pose X = place_of(*model, frame.child, q);
    EXPECT_TRUE(X.isApprox(frames[frame.child], 1e-6)) << frame.child;
  }
  EXPECT_EQ(model->links_.size(), frames.size()) << "and no link without a frame";
}

TEST_F(RobotDescription, ShapesHangAtTheLinkThatCarriesThem) {
  const auto model = read(all);
  std::size_t visuals = 0;
  for (const auto& [name, link] : model->links_) visuals += link->visual_array.size();
  std::size_t drawn = 0;
  for (const CompiledGeometry& shape : compiled->geometry)
    drawn += shape.geometry->drawn ? (shape.geometry->shape == Shape::capsule ? 3 : 1) : 0;
  EXPECT_EQ(visuals, drawn);
  ASSERT_TRUE(model->getLink("PUMA_762/J_2"));
  EXPECT_FALSE(model->getLink("PUMA_762/J_2")->visual_array.empty());
}

TEST_F(RobotDescription, NamesOfJointsThatTwoRobotsHaveCarryTheRobot) {
  const auto model = read(all);
  EXPECT_TRUE(model->getJoint("J_0")) << "the gantry alone has it";
  EXPECT_TRUE(model->getJoint("MANTEC_R3/J_1"));
  EXPECT_FALSE(model->getJoint("J_1"));
  std::vector<bool> one(all.size(), false);
  for (std::size_t i = 0; i < one.size(); ++i) one[i] = compiled->robots[i].id == "MANTEC_R3";
  const auto alone = read(one);
  EXPECT_TRUE(alone->getJoint("J_1"));
  EXPECT_FALSE(alone->getLink("PUMA_762/base"));
}

TEST_F(RobotDescription, OfNoRobotIsTheWorldAlone) {
  const auto model = read(std::vector<bool>(all.size(), false));
  EXPECT_EQ(model->links_.size(), 1U);
}

TEST(RobotDescriptionText, NamesAndPathsOfAnyBytesAreQuoted) {
  CompiledCell cell;
  cell.name = "a<&\"b";
  cell.parent = {-1};
  cell.naming_parent = {-1};
  cell.X_PF = {Pose::Identity()};
  cell.joint_of = {-1};
  cell.visible = {1};
  cell.X_WN_fixed = {Pose::Identity()};
  cell.fixed_count = 1;
  auto mesh = std::make_shared<Geometry>();
  mesh->shape = Shape::mesh;
  mesh->size = {1, 1, 1};
  mesh->mesh_file = "/home/a b/\"x\"&%.stl";
  cell.geometry.push_back({0, mesh});
  const std::string text = robot_description(cell, {});
  EXPECT_THAT(text, HasSubstr("name=\"a&lt;&amp;&quot;b\""));
  EXPECT_THAT(text, HasSubstr("filename=\"file:///home/a%20b/%22x%22%26%25.stl\""));
  EXPECT_TRUE(urdf::parseURDF(text));
}

}  // namespace
}  // namespace cellmirror::app
