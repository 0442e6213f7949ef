// Chains out of components and robots.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "rt_core/cell/robot_chain.hpp"
#include "rt_core/kinematics/forward.hpp"
#include "tests/unit/cell/cell_from_text.hpp"
#include "tests/unit/kinematics/chain_support.hpp"
#include "tests/unit/kinematics/shared_arms.hpp"

namespace cellmirror {
namespace {

using kinematics::Chain;
using kinematics::difference;
using kinematics::forward;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kLimit = R"(<limit lower="-1" upper="2" velocity="1" effort="1"/>)";

std::string link(const std::string& name) { return "<link name=\"" + name + "\"/>"; }
std::string joint(const std::string& name, const std::string& kind, const std::string& parent, const std::string& child,
                  const std::string& more) {
  return "<joint name=\"" + name + "\" type=\"" + kind + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/><origin xyz=\"0 0 1\"/>" + more + "</joint>\n";
}
std::string robot(const std::string& elements) { return "<robot name=\"R\">" + elements + "</robot>"; }

// base - turn - arm - lift - hand - finger (a mimic of lift), with a fixed camera on the arm.
std::string small_robot() {
  return robot(link("base") + link("arm") + link("hand") + link("finger") + link("camera") +
               joint("turn", "continuous", "base", "arm", R"(<axis xyz="0 0 1"/>)") +
               joint("lift", "prismatic", "arm", "hand", std::string(R"(<axis xyz="1 0 0"/>)") + kLimit) +
               joint("squeeze", "revolute", "hand", "finger",
                     R"(<axis xyz="0 1 0"/><mimic joint="lift" multiplier="0.5" offset="0.1"/>)") +
               joint("mount", "fixed", "arm", "camera", ""));
}

std::vector<std::string> names(const Chain& chain) {
  std::vector<std::string> out;
  for (const auto& variable : chain.variables()) out.push_back(variable.name);
  return out;
}

std::string refusal(const std::string& urdf, const std::string& base, const std::string& tip) {
  const auto chain = chain_between(component_of_urdf(urdf), base, tip);
  return chain ? "accepted" : chain.error().text();
}

TEST(ChainBetween, takesVariablesInTheOrderFromBaseToTip) {
  const Chain sut = chain_of_urdf(small_robot(), "base", "hand");
  EXPECT_THAT(names(sut), ElementsAre("turn", "lift"));
  EXPECT_TRUE(sut.plain());
  EXPECT_EQ(sut.lower()[0], -std::numeric_limits<double>::infinity());
  EXPECT_EQ(sut.upper()[1], 2.0);
  const double q[] = {0.4, 0.3};
  const Pose expected = kinematics::translation(0, 0, 1) * kinematics::turn(0.4, Eigen::Vector3d::UnitZ()) *
                        kinematics::translation(0.3, 0, 1);
  EXPECT_LT(difference(forward(sut, q), expected), 1e-15);
  EXPECT_THAT(names(chain_of_urdf(small_robot(), "hand", "base")), ElementsAre("lift", "turn"));
}

TEST(ChainBetween, goesUpAndDownAcrossBranches) {
  const Chain sut = chain_of_urdf(small_robot(), "camera", "hand");
  EXPECT_THAT(names(sut), ElementsAre("lift"));
  const double q[] = {0.3};
  EXPECT_LT(difference(forward(sut, q), kinematics::translation(0.3, 0, 0)), 1e-15);
}

TEST(ChainBetween, drivesMimicsByTheirMaster) {
  const Chain sut = chain_of_urdf(small_robot(), "base", "finger");
  EXPECT_THAT(names(sut), ElementsAre("turn", "lift"));
  EXPECT_FALSE(sut.plain());
  const double q[] = {0.0, 0.3};
  const Pose expected = kinematics::translation(0.3, 0, 3) * kinematics::turn(0.25, Eigen::Vector3d::UnitY());
  EXPECT_LT(difference(forward(sut, q), expected), 1e-15);
  // The master lies outside of this chain, but it is what moves the finger.
  EXPECT_THAT(names(chain_of_urdf(small_robot(), "hand", "finger")), ElementsAre("lift"));
}

TEST(ChainBetween, asksOnlyForWhatLiesBetween) {
  // A hand with more joints than a robot may have: the reader refuses the robot, the chain of the arm is fine.
  std::string urdf = link("L0");
  for (int i = 1; i <= 20; ++i) {
    urdf += link("L" + std::to_string(i)) +
            joint("J" + std::to_string(i), "revolute", "L" + std::to_string(i - 1), "L" + std::to_string(i), kLimit);
  }
  Diagnostics diagnostics;
  const auto component = parse_urdf(robot(urdf), "r.urdf", "r.urdf", AnyFile(), diagnostics);
  ASSERT_TRUE(component);
  const auto part = chain_between(*component, "L3", "L10");
  ASSERT_TRUE(part) << part.error().text();
  EXPECT_EQ(part->variable_count(), 7U);
  const auto whole = chain_between(*component, "L0", "L20");
  ASSERT_FALSE(whole);
  EXPECT_THAT(whole.error().what, HasSubstr("20 joints"));
}

TEST(ChainBetween, takesPathsOfNodesToo) {
  EXPECT_THAT(names(chain_of_urdf(small_robot(), "base.turn.arm", "base.hand")), ElementsAre("lift"));
}

TEST(ChainBetween, meansTheLinkWhereAJointHasTheSameName) {
  const std::string urdf =
      robot(link("base") + link("elbow") + link("tip") + joint("elbow", "revolute", "base", "elbow", kLimit) +
            joint("wrist", "revolute", "elbow", "tip", kLimit));
  EXPECT_THAT(names(chain_of_urdf(urdf, "elbow", "tip")), ElementsAre("wrist"));
}

TEST(ChainBetween, refusesUnknownNamesWithTheNearest) {
  EXPECT_THAT(refusal(small_robot(), "basis", "hand"), AllOf(HasSubstr("base of the chain"), HasSubstr("basis")));
  EXPECT_THAT(refusal(small_robot(), "base", "handd"),
              AllOf(HasSubstr("tip of the chain"), HasSubstr("did you mean hand?")));
  EXPECT_THAT(refusal(small_robot(), "", "hand"), HasSubstr("empty"));
  EXPECT_THAT(refusal(small_robot(), "base", "ha\nnd"), HasSubstr("ha\\x0and"));
}

TEST(ChainBetween, refusesTwoLinksWithNoJointBetween) {
  EXPECT_THAT(refusal(small_robot(), "arm", "camera"),
              AllOf(HasSubstr("no joint"), HasSubstr("arm"), HasSubstr("camera")));
  EXPECT_THAT(refusal(small_robot(), "arm", "arm"), HasSubstr("no joint"));
}

// As a reader may leave them where it has findings, or a program that makes components itself.
TEST(ChainBetween, tellsWhichJointIsFaultyAndWhere) {
  Component component = component_of_urdf(small_robot());
  const auto lift = std::ranges::find(component.nodes, "lift", &ComponentNode::name);
  ASSERT_NE(lift, component.nodes.end());
  lift->line = 12;
  const auto refused = [&] { return chain_between(component, "base", "hand").error().text(); };
  lift->joint->axis.setZero();
  EXPECT_THAT(refused(), AllOf(HasSubstr("test.urdf:12"), HasSubstr("axis of joint lift"), HasSubstr("length zero")));
  lift->joint->axis = Eigen::Vector3d::UnitX();
  std::swap(lift->joint->min_position, lift->joint->max_position);
  EXPECT_THAT(refused(), AllOf(HasSubstr("test.urdf:12"), HasSubstr("lift"), HasSubstr("swapped limits")));
  lift->joint->min_position = NAN;
  EXPECT_THAT(refused(), AllOf(HasSubstr("test.urdf:12"), HasSubstr("lift")));
  lift->X_PF.translation().x() = NAN;
  EXPECT_THAT(refused(), AllOf(HasSubstr("test.urdf:12"), HasSubstr("pose of lift")));
  lift->joint->mimic = Mimic{"nobody"};
  lift->X_PF = Pose::Identity();
  EXPECT_THAT(refused(), AllOf(HasSubstr("test.urdf:12"), HasSubstr("lift mimics nobody")));
}

TEST(ComponentTree, hasTheLinksOfAllNodes) {
  const Component component = component_of_urdf(small_robot());
  const auto sut = component_tree(component);
  ASSERT_TRUE(sut) << sut.error().text();
  ASSERT_EQ(sut->links().size(), component.nodes.size());
  ASSERT_EQ(sut->variables().size(), 2U);
  EXPECT_EQ(sut->variables()[1].name, "lift");
  const double q[] = {0.2, 0.3};
  std::vector<Pose> X_RL(sut->links().size());
  forward(*sut, q, X_RL);
  const Chain finger = chain_of_urdf(small_robot(), "base", "finger");
  const auto node = std::ranges::find(component.nodes, "finger", &ComponentNode::name) - component.nodes.begin();
  EXPECT_LT(difference(X_RL[static_cast<std::size_t>(node)], forward(finger, q)), 1e-15);
}

// --- Of a robot in a cell.

// kArm with a gripper of its own beyond the flange, a mimic below the flange, and a ZP frame beside the base.
constexpr const char* kArmWithGripper = R"(
[[node]]
name = "ZP"
xyz_m = [0.0, 0.0, -0.5]
rpy_rad = [0, 0, 1.5]
[[node]]
name = "GRIP"
joint = { type = "prismatic", axis = [0, 0, 1], range_m = [0.0, 0.1], velocity_m_s = 1.0 }
[[node]]
name = "LIFT"
xyz_m = [0.1, 0.0, 0.0]
joint = { type = "prismatic", axis = [0, 0, 1], range_m = [0.0, 2.0], velocity_m_s = 1.5 }
[[node]]
name = "TURN"
parent = "LIFT"
xyz_m = [1.0, 0.0, 0.0]
joint = { type = "revolute", axis = [0.6, 0, 0.8], range_rad = [-3.0, 3.0], velocity_rad_s = 2.0 }
[[node]]
name = "COUNTER"
parent = "TURN"
xyz_m = [1.0, 0.0, 0.0]
joint = { type = "revolute", axis = [0, 1, 0], mimic = { joint = "TURN", multiplier = -0.5, offset_rad = 0.2 } }
[[node]]
name = "TIP"
parent = "COUNTER"
xyz_m = [1.0, 0.0, 0.0]
[robot]
id = "ARM"
flange = "TIP"
zero_point = "ZP"
tool_center_point = { xyz_m = [0.0, 0.2, 0.0], rpy_rad = [0.1, 0.2, 0.3] }
)";

struct RobotChains : testing::Test {
  RobotChains() {
    files->add("arm.mpc", kArmWithGripper);
    Diagnostics diagnostics;
    cell =
        build_cell("[[node]]\nname = \"Arm\"\nxyz_m = [1, 2, 3]\nrpy_rad = [0.5, 0.6, 0.7]\nabstract = \"arm.mpc\"\n",
                   files, diagnostics);
    EXPECT_TRUE(cell) << diagnostics.text();
  }
  std::shared_ptr<TextFiles> files = std::make_shared<TextFiles>();
  std::optional<Cell> cell;
};

TEST_F(RobotChains, takeTheJointsThatMoveTheTool) {
  const auto sut = robot_chain(*cell, "ARM");
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_THAT(names(sut->chain), ElementsAre("LIFT", "TURN"));
  EXPECT_THAT(sut->joint, ElementsAre(1, 2));
  EXPECT_THAT(sut->variables_of({7, 8, 9}), testing::Each(testing::AnyOf(8, 9, 0)));
  EXPECT_EQ(sut->joints_of({1, 2}, {7, 8, 9}), (JointValues{7, 1, 2}));
}

TEST_F(RobotChains, agreeWithThePicturesOfTheCell) {
  const auto to_tool = robot_chain(*cell, "ARM");
  const auto to_flange = robot_chain(*cell, "ARM", ChainTip::flange);
  ASSERT_TRUE(to_tool && to_flange);
  const auto picture = cell->compile();
  const CompiledRobot* robot = picture->robot(cell->robot("ARM")->slot());
  std::mt19937_64 random(1);
  CellPoses poses;
  std::vector<JointValues> q(kMaxRobots);
  for (int i = 0; i < 100; ++i) {
    const JointValues variables = random_posture(to_tool->chain, random);
    q[robot->slot] = to_tool->joints_of(variables, {0.05});
    compute_poses(*picture, q, poses);
    EXPECT_LT(difference(forward(to_tool->chain, variables), tcp_poses(*robot, poses).X_ZT), 1e-13);
    const Pose X_ZF = tcp_poses(*robot, poses).X_ZT * robot->X_FT.inverse();
    EXPECT_LT(difference(forward(to_flange->chain, variables), X_ZF), 1e-13);
  }
}

TEST_F(RobotChains, haveThePresentLimitsAndTool) {
  const double lower[] = {0.0, 0.5, -1.0};
  ASSERT_TRUE(cell->edit_robot("ARM")->set_joint_parameter(JointParameter::min_range, lower));
  ASSERT_TRUE(cell->edit_robot("ARM")->set_tool_center_point(Pose::Identity()));
  const auto sut = robot_chain(*cell, "ARM");
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_THAT(sut->chain.lower(), ElementsAre(0.5, -1.0));
  EXPECT_THAT(sut->chain.upper(), ElementsAre(2.0, 3.0));
  const auto to_flange = robot_chain(*cell, "ARM", ChainTip::flange);
  EXPECT_EQ(difference(sut->chain.X_LT(), to_flange->chain.X_LT()), 0);
}

TEST_F(RobotChains, ofUnknownRobotsAreRefusedWithTheNearest) {
  const auto sut = robot_chain(*cell, "ARN");
  ASSERT_FALSE(sut);
  EXPECT_THAT(sut.error().text(), AllOf(HasSubstr("ARN"), HasSubstr("ARM")));
}

// Trees, chains and pictures of the same arms.
TEST(SharedArms, moveAlikeInTreesAndChains) {
  const auto arms = shared_arms();
  if (arms.empty()) GTEST_SKIP() << "skipped: the robots of ../shared/data are not on this machine";
  std::mt19937_64 random(2);
  for (const SharedArm& arm : arms) {
    const Component component = component_of_urdf(arm.urdf);
    const auto tree = component_tree(component);
    ASSERT_TRUE(tree) << tree.error().text();
    const Chain chain = chain_of_urdf(arm.urdf, arm.base, arm.tip);
    ASSERT_EQ(tree->variables().size(), chain.variable_count()) << arm.id;
    const auto node = [&](const std::string& name) {
      return static_cast<std::size_t>(std::ranges::find(component.nodes, name, &ComponentNode::name) -
                                      component.nodes.begin());
    };
    std::vector<Pose> X_RL(tree->links().size());
    for (int i = 0; i < 100; ++i) {
      const JointValues q = random_posture(chain, random);
      forward(*tree, q, X_RL);
      EXPECT_LT(difference(X_RL[node(arm.base)].inverse() * X_RL[node(arm.tip)], forward(chain, q)), 1e-13) << arm.id;
    }
  }
}

// --- Chain itself.

std::string refused(std::vector<kinematics::Variable> variables, std::vector<kinematics::ChainJoint> joints,
                    const Pose& X_LT = Pose::Identity()) {
  const auto chain = Chain::make(std::move(variables), joints, X_LT);
  return chain ? "accepted" : chain.error().what;
}

TEST(ChainMake, refusesWhatIsNoChain) {
  const kinematics::Variable good{"q1", JointKind::revolute, -1, 1};
  EXPECT_EQ(refused({good}, {{}}), "accepted");
  EXPECT_THAT(refused({}, {}), HasSubstr("no joint"));
  EXPECT_THAT(refused({good, {"q2", JointKind::revolute, -1, 1}}, {{}}),
              AllOf(HasSubstr("q2"), HasSubstr("does not move")));
  EXPECT_THAT(refused({{"q1", JointKind::revolute, 1, -1}}, {{}}), AllOf(HasSubstr("q1"), HasSubstr("swapped limits")));
  EXPECT_THAT(refused({{"q1", JointKind::revolute, NAN, 1}}, {{}}), AllOf(HasSubstr("q1"), HasSubstr("finite")));
  EXPECT_THAT(refused({good}, std::vector<kinematics::ChainJoint>(kinematics::kMaxChainJoints + 1)),
              HasSubstr("at most"));
  kinematics::ChainJoint without_variable;
  without_variable.variable = 3;
  EXPECT_THAT(refused({good}, {without_variable}), HasSubstr("no variable"));
  Pose X = Pose::Identity();
  X.translation().x() = NAN;
  EXPECT_THAT(refused({good}, {{}}, X), HasSubstr("tip"));
}

TEST(ChainMake, withTipAndLimitsChangesNothingElse) {
  std::mt19937_64 random(3);
  const Chain chain = kinematics::random_chain(6, true, random);
  const auto q = kinematics::random_values(6, 1.0, random);
  const Pose X_LT = kinematics::random_pose(random);
  const Chain sut = chain.with_tip(X_LT);
  EXPECT_LT(difference(forward(sut, q), forward(chain, q) * chain.X_LT().inverse() * X_LT), 1e-13);
  const std::vector<double> lower(6, -0.5);
  const std::vector<double> upper(6, 0.5);
  const auto narrowed = chain.with_limits(lower, upper);
  ASSERT_TRUE(narrowed);
  EXPECT_THAT(narrowed->lower(), testing::Each(-0.5));
  EXPECT_EQ(difference(forward(*narrowed, q), forward(chain, q)), 0);
  EXPECT_FALSE(chain.with_limits(upper, lower));
}

}  // namespace
}  // namespace cellmirror
