#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <numbers>
#include <random>

#include "config/cell_file.hpp"
#include "config/parse.hpp"
#include "rt_core/base/pose.hpp"
#include "tests/unit/config/mesh_text.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

struct ParsedRobot {
  std::optional<Component> component;
  Diagnostics diagnostics;
};

ParsedRobot parse(const std::string& inside) {
  ParsedRobot parsed;
  parsed.component =
      parse_urdf("<robot name=\"r\">\n" + inside + "</robot>", "r.urdf", "/r.urdf", AnyFile(), parsed.diagnostics);
  return parsed;
}

std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                  const std::string& type = "fixed", const std::string& more = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/>" + more + "</joint>\n";
}
const std::string kJointLimit = "<limit lower=\"-1\" upper=\"1\" velocity=\"2\" effort=\"5\"/>";

TEST(Urdf, becomesNodesAndARobot) {
  const ParsedRobot sut = parse("<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>" +
                                joint("ab", "a", "b", "revolute", "<axis xyz=\"0 0 2\"/>" + kJointLimit) +
                                joint("bc", "b", "c", "fixed", "<origin xyz=\"1 2 3\"/>"));
  ASSERT_TRUE(sut.diagnostics.ok()) << sut.diagnostics.text();
  ASSERT_EQ(sut.component->nodes.size(), 4U);
  EXPECT_EQ(sut.component->nodes[1].name, "ab");
  EXPECT_EQ(sut.component->nodes[1].joint->axis, Eigen::Vector3d::UnitZ()) << "normalized";
  EXPECT_EQ(sut.component->nodes[3].name, "c");
  EXPECT_EQ(sut.component->nodes[3].X_PF.translation(), Eigen::Vector3d(1, 2, 3));
  ASSERT_TRUE(sut.component->robot);
  EXPECT_EQ(sut.component->robot->id, "r");
  EXPECT_EQ(sut.component->robot->flange, 3);
  EXPECT_EQ(sut.component->robot->parameters.max_velocity[0], 2.0);
}

TEST(Urdf, mimicJointsFollowAndAreNotCommanded) {
  const ParsedRobot sut = parse(
      "<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>" + joint("ab", "a", "b", "revolute", kJointLimit) +
      joint("bc", "b", "c", "prismatic", kJointLimit + "<mimic joint=\"ab\" multiplier=\"0.5\" offset=\"0.1\"/>"));
  ASSERT_TRUE(sut.diagnostics.ok()) << sut.diagnostics.text();
  EXPECT_EQ(sut.component->robot->joints.size(), 1U);
  EXPECT_EQ(sut.component->nodes[3].joint->mimic->multiplier, 0.5);
}

// c = 2 b + 0.3 and b = -a + 0.1, so that c = -2 a + 0.5.
TEST(Urdf, aMimicOfAMimicFollowsItsJoint) {
  const ParsedRobot sut =
      parse("<link name=\"l0\"/><link name=\"l1\"/><link name=\"l2\"/><link name=\"l3\"/>" +
            joint("a", "l0", "l1", "revolute", kJointLimit) +
            joint("c", "l1", "l2", "revolute", kJointLimit + "<mimic joint=\"b\" multiplier=\"2\" offset=\"0.3\"/>") +
            joint("b", "l2", "l3", "revolute", kJointLimit + "<mimic joint=\"a\" multiplier=\"-1\" offset=\"0.1\"/>"));
  ASSERT_TRUE(sut.diagnostics.ok()) << sut.diagnostics.text();
  EXPECT_EQ(sut.component->robot->joints.size(), 1U);
  for (const ComponentNode& node : sut.component->nodes) {
    if (node.name != "c") continue;
    EXPECT_EQ(node.joint->mimic->joint, "a");
    EXPECT_DOUBLE_EQ(node.joint->mimic->multiplier, -2);
    EXPECT_DOUBLE_EQ(node.joint->mimic->offset, 0.5);
  }
}

TEST(Urdf, aQuaternionTurnsAnOrigin) {
  const ParsedRobot sut = parse("<link name=\"a\"/><link name=\"b\"/>" +
                                joint("x", "a", "b", "fixed", "<origin xyz=\"0 0 1\" quat_xyzw=\"0 0 1 1\"/>"));
  ASSERT_TRUE(sut.diagnostics.ok()) << sut.diagnostics.text();
  const Pose& pose = sut.component->nodes[1].X_PF;
  EXPECT_TRUE((pose.linear() * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-12)) << pose.matrix();
  EXPECT_EQ(pose.translation(), Eigen::Vector3d::UnitZ());
}

TEST(Urdf, aJointMayHaveOnePosition) {
  const ParsedRobot sut =
      parse("<link name=\"a\"/><link name=\"b\"/>" +
            joint("x", "a", "b", "prismatic",
                  "<axis xyz=\"0 0 1\"/><limit lower=\"0.2\" upper=\"0.2\" velocity=\"1\" effort=\"1\"/>"));
  ASSERT_TRUE(sut.diagnostics.ok()) << sut.diagnostics.text();
  EXPECT_EQ(sut.component->robot->joints.size(), 1U);
  EXPECT_EQ(sut.component->robot->parameters.start_position[0], 0.2);
}

TEST(Urdf, aFloatingJointStaysAtItsOriginWithAWarning) {
  const ParsedRobot sut = parse("<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>" +
                                joint("x", "a", "b", "floating") + joint("y", "b", "c", "revolute", kJointLimit));
  ASSERT_TRUE(sut.diagnostics.ok()) << sut.diagnostics.text();
  EXPECT_THAT(sut.diagnostics.text(), HasSubstr("of type floating; its child stays at its origin"));
  EXPECT_EQ(sut.component->robot->joints.size(), 1U);
}

TEST(Urdf, aRobotWhoseNameNoCommandCanWriteGetsASimilarOne) {
  Diagnostics diagnostics;
  const auto sut = parse_urdf("<robot name=\"My Robot v1.2\"><link name=\"a\"/><link name=\"b\"/>" +
                                  joint("x", "a", "b", "revolute", kJointLimit) + "</robot>",
                              "r.urdf", "/r.urdf", AnyFile(), diagnostics);
  ASSERT_TRUE(diagnostics.ok()) << diagnostics.text();
  EXPECT_EQ(sut->robot->id, "My_Robot_v1_2");
  EXPECT_THAT(diagnostics.text(), HasSubstr("the robot is called My_Robot_v1_2"));
}

TEST(Urdf, whatIsOnlyDrawnAndMissingIsAWarning) {
  const ParsedRobot sut = parse(
      "<link name=\"a\"><visual><geometry><box size=\"0 0 0\"/></geometry></visual>"
      "<visual><geometry><sphere radius=\"0\"/></geometry></visual>"
      "<collision><geometry><box size=\"1 1 1\"/></geometry></collision></link><link name=\"b\"/>" +
      joint("x", "a", "b", "revolute", kJointLimit));
  ASSERT_TRUE(sut.diagnostics.ok()) << sut.diagnostics.text();
  EXPECT_THAT(sut.diagnostics.text(), HasSubstr("an edge of the box is not positive; it is not drawn"));
  EXPECT_THAT(sut.diagnostics.text(), HasSubstr("radius is 0, but must be positive; it is not drawn"));
  EXPECT_THAT(sut.diagnostics.text(), testing::Not(HasSubstr("COLLISIONS")));
  EXPECT_EQ(sut.component->nodes[0].geometry.size(), 1U);
}

TEST(Urdf, aRobotOfWhichNothingCollidesSaysSoLoudly) {
  const ParsedRobot sut = parse(
      "<link name=\"a\"><visual><geometry><box size=\"1 1 1\"/></geometry></visual></link>"
      "<link name=\"b\"/>" +
      joint("x", "a", "b", "revolute", kJointLimit));
  ASSERT_TRUE(sut.diagnostics.ok()) << sut.diagnostics.text();
  EXPECT_THAT(sut.diagnostics.text(), HasSubstr("COLLISIONS OF THIS ROBOT ARE NOT FOUND"));
}

struct Fault {
  const char* name;
  std::string text;
  const char* message;
};
struct FaultyUrdf : testing::TestWithParam<Fault> {};

TEST_P(FaultyUrdf, isRefusedWithAPlace) {
  const ParsedRobot sut = parse(GetParam().text);
  EXPECT_FALSE(sut.diagnostics.ok());
  EXPECT_THAT(sut.diagnostics.text(), HasSubstr(GetParam().message));
  EXPECT_THAT(sut.diagnostics.text(), HasSubstr("r.urdf"));
}

INSTANTIATE_TEST_SUITE_P(
    All, FaultyUrdf,
    testing::Values(
        Fault{"twoRoots", "<link name=\"a\"/><link name=\"b\"/>", "is a root link"},
        Fault{"circle", "<link name=\"a\"/><link name=\"b\"/>" + joint("x", "a", "b") + joint("y", "b", "a"), "loop"},
        Fault{"circleBesideTheRoot",
              "<link name=\"r\"/><link name=\"a\"/><link name=\"b\"/>" + joint("x", "a", "b") + joint("y", "b", "a"),
              "loop"},
        Fault{"itself", "<link name=\"a\"/>" + joint("x", "a", "a"), "to itself"},
        Fault{"twoParents",
              "<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>" + joint("x", "a", "c") + joint("y", "b", "c"),
              "two parents"},
        Fault{"unknownLink", "<link name=\"base\"/>" + joint("x", "bsae", "base"), "did you mean base"},
        Fault{"twoLinks", "<link name=\"a\"/><link name=\"a\"/>", "two links a"},
        Fault{"twoJoints",
              "<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>" + joint("x", "a", "b") + joint("x", "b", "c"),
              "two joints x"},
        Fault{"noLimit", "<link name=\"a\"/><link name=\"b\"/>" + joint("x", "a", "b", "revolute"), "needs <limit>"},
        Fault{"limitsTurnedRound",
              "<link name=\"a\"/><link name=\"b\"/>" +
                  joint("x", "a", "b", "revolute", "<limit lower=\"1\" upper=\"-1\" velocity=\"1\" effort=\"1\"/>"),
              "lower 1 is not below upper -1"},
        Fault{"notANumber",
              "<link name=\"a\"/><link name=\"b\"/>" + joint("x", "a", "b", "fixed", "<origin xyz=\"0 nan 0\"/>"),
              "not a number"},
        Fault{"twoNumbers",
              "<link name=\"a\"/><link name=\"b\"/>" + joint("x", "a", "b", "fixed", "<origin xyz=\"0 0\"/>"),
              "must have 3 numbers"},
        Fault{"noAxis",
              "<link name=\"a\"/><link name=\"b\"/>" +
                  joint("x", "a", "b", "revolute", "<axis xyz=\"0 0 0\"/>" + kJointLimit),
              "has length zero"},
        Fault{"type", "<link name=\"a\"/><link name=\"b\"/>" + joint("x", "a", "b", "ball"), "cannot be used"},
        Fault{"circleOfMimics",
              "<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>" +
                  joint("x", "a", "b", "revolute", kJointLimit + "<mimic joint=\"y\"/>") +
                  joint("y", "b", "c", "revolute", kJointLimit + "<mimic joint=\"x\"/>"),
              "x mimics itself by way of y"},
        Fault{"xacroElement", "<link name=\"a\"/><xacro:property name=\"p\" value=\"1\"/>", "xacro FILE > FILE.urdf"},
        Fault{"xacroValue", "<link name=\"${p}tool\"/>", "not expanded: ${p}tool"},
        Fault{"xacroCommand", "<link name=\"$(arg p)tool\"/>", "not expanded: $(arg p)tool"},
        Fault{"turnedTwice",
              "<link name=\"a\"/><link name=\"b\"/>" +
                  joint("x", "a", "b", "fixed", "<origin rpy=\"0 0 0\" quat_xyzw=\"0 0 0 1\"/>"),
              "use one of them"},
        Fault{"noTurn",
              "<link name=\"a\"/><link name=\"b\"/>" + joint("x", "a", "b", "fixed", "<origin quat_xyzw=\"0 0 0 0\"/>"),
              "quat_xyzw has length zero"},
        Fault{"mimicOfNothing",
              "<link name=\"a\"/><link name=\"b\"/>" +
                  joint("x", "a", "b", "revolute", kJointLimit + "<mimic joint=\"y\"/>"),
              "does not exist"},
        Fault{"name", "<link name=\"a.b\"/>", "not a valid name"},
        Fault{"shape", "<link name=\"a\"><visual><geometry><cone/></geometry></visual></link>", "not a shape"},
        Fault{"size", "<link name=\"a\"><collision><geometry><sphere radius=\"-1\"/></geometry></collision></link>",
              "must be positive"},
        Fault{"mass", "<link name=\"a\"><inertial><mass value=\"-1\"/></inertial></link>", "mass is negative"},
        Fault{"nothing", "", "no link"}),
    [](const auto& fault) { return std::string(fault.param.name); });

TEST(Urdf, hostileTextsAreRefused) {
  const auto refused = [](const std::string& text, const char* message) {
    Diagnostics diagnostics;
    EXPECT_FALSE(parse_urdf(text, "r.urdf", "/r.urdf", AnyFile(), diagnostics).has_value());
    EXPECT_THAT(diagnostics.text(), HasSubstr(message));
  };
  refused("", "XML is faulty");
  refused("<robot", "XML is faulty");
  refused("<!DOCTYPE robot [<!ENTITY x SYSTEM \"file:///etc/passwd\">]><robot name=\"r\">&x;</robot>", "declaration");
  refused("<sdf/>", "<robot>");
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  refused("<robot name=\"r\">" + deep, "XML is faulty");
  refused(std::string("<robot name=\"r\">\0</robot>", 25), "NUL");
}

TEST(Urdf, longChainsDoNotExhaustTheStack) {
  std::string text = "<link name=\"l0\"/>";
  for (int i = 1; i < 9'000; ++i) {
    text += "<link name=\"l" + std::to_string(i) + "\"/>";
    text += joint("j" + std::to_string(i), "l" + std::to_string(i - 1), "l" + std::to_string(i));
  }
  const ParsedRobot sut = parse(text);
  ASSERT_TRUE(sut.diagnostics.ok()) << sut.diagnostics.text();
  EXPECT_EQ(sut.component->nodes.size(), 9'000U);
}

// A tetrahedron that faces inwards.
std::string findings_of_hollow(double size) {
  const TemporaryHome home;
  home.write("room.obj", fmt::format("v 0 0 0\nv {0} 0 0\nv 0 {0} 0\nv 0 0 {0}\n"
                                     "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n",
                                     size));
  const auto path = home.write("room.urdf",
                               "<robot name=\"r\"><link name=\"a\"><collision><geometry><mesh filename=\"room.obj\"/>"
                               "</geometry></collision></link></robot>");
  Diagnostics diagnostics;
  check_file(path, diagnostics);
  return diagnostics.text();
}

TEST(UrdfMeshes, anInsideOutOneOfTheSizeOfARoomIsAWarning) {
  EXPECT_THAT(findings_of_hollow(0.3), HasSubstr("note: the mesh room.obj: 1 shell was inside out"));
  EXPECT_THAT(findings_of_hollow(3),
              HasSubstr("warning: the mesh room.obj: 1 shell was inside out; its inside is solid"));
}

TEST(UrdfMeshes, oneOfHundredsOfMetresIsAWarning) {
  EXPECT_THAT(findings_of_hollow(3), testing::Not(HasSubstr("millimetres")));
  EXPECT_THAT(findings_of_hollow(300),
              HasSubstr("warning: the mesh room.obj is 300 m long; where it was drawn in milli"));
}

TEST(UrdfMeshes, areFoundBesideTheFileAndInPackagesAndNowhereElse) {
  const TemporaryHome home;
  home.write("robots/arm/meshes/a.stl", tetra_stl());
  home.write("secret.stl", "solid");
  const auto check = [&](const std::string& mesh) {
    const auto path = home.write("robots/arm/urdf/arm.urdf",
                                 "<robot name=\"r\"><link name=\"a\"><collision><geometry><mesh filename=\"" + mesh +
                                     "\"/></geometry></collision></link></robot>");
    home.write("cell.toml", "");
    Diagnostics diagnostics;
    check_file(path, diagnostics);
    return diagnostics.text();
  };
  EXPECT_EQ(check("../meshes/a.stl"), "");
  EXPECT_EQ(check("package://arm/meshes/a.stl"), "");
  EXPECT_THAT(check("../../../../etc/passwd"), HasSubstr("leaves"));
  EXPECT_THAT(check("/etc/passwd"), HasSubstr("absolute"));
  EXPECT_THAT(check("package://arm/../../../../../etc/passwd"), HasSubstr("error"));
  EXPECT_THAT(check("http://host/a.stl"), HasSubstr("not a file"));
  EXPECT_THAT(check("package://other/meshes/a.stl"), HasSubstr("no file package://other"));
  EXPECT_THAT(check("../meshes"), HasSubstr("folder"));
  EXPECT_THAT(check("../meshes/missing.stl"), HasSubstr("does not exist"));
}

TEST(UrdfMeshes, oneThatIsOnlyDrawnMayBeMissing) {
  const TemporaryHome home;
  home.write("cell.toml", "");
  const auto path = home.write("robots/arm.urdf",
                               "<robot name=\"r\"><link name=\"a\"><visual><geometry><mesh filename=\"none.dae\"/>"
                               "</geometry></visual></link></robot>");
  Diagnostics diagnostics;
  check_file(path, diagnostics);
  EXPECT_TRUE(diagnostics.ok());
  EXPECT_THAT(diagnostics.text(), HasSubstr("does not exist"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("it is not drawn"));
}

// --- against urdfdom, on the robots of the shared data
// ------------------------------------------------------------------

fs::path shared_data() {
  if (const char* folder = std::getenv("CELLMIRROR_SHARED_DATA")) return folder;
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  return source != nullptr ? fs::path(source).parent_path() / "shared/data" : fs::path();
}

Pose pose_of(const urdf::Pose& X) {
  Pose out = Pose::Identity();
  out.translation() = Eigen::Vector3d(X.position.x, X.position.y, X.position.z);
  out.linear() = Eigen::Quaterniond(X.rotation.w, X.rotation.x, X.rotation.y, X.rotation.z).toRotationMatrix();
  return out;
}

Pose link_pose(const urdf::ModelInterface& model, const std::string& name, const std::map<std::string, double>& q) {
  const auto link = model.getLink(name);
  if (!link->parent_joint) return Pose::Identity();
  const urdf::Joint& joint = *link->parent_joint;
  Pose X = pose_of(joint.parent_to_joint_origin_transform);
  const Eigen::Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
  const auto position = q.find(joint.name);
  if (position != q.end() && joint.type == urdf::Joint::PRISMATIC) X.translate(axis * position->second);
  if (position != q.end() && joint.type != urdf::Joint::PRISMATIC) X.rotate(Eigen::AngleAxisd(position->second, axis));
  return link_pose(model, joint.parent_link_name, q) * X;
}

class OneFile final : public ComponentSource {
 public:
  explicit OneFile(Component component) : component_(std::make_shared<const Component>(std::move(component))) {}
  Result<std::shared_ptr<const Component>> component(std::string_view) override { return component_; }

 private:
  std::shared_ptr<const Component> component_;
};

TEST(Urdf, agreesWithUrdfdomOnRealRobots) {
  const fs::path robots = shared_data() / "robots";
  if (!fs::is_directory(robots)) GTEST_SKIP() << "skipped: no shared data at " << robots;
  int compared = 0;
  for (const auto& entry : fs::recursive_directory_iterator(robots)) {
    if (entry.path().extension() != ".urdf") continue;
    SCOPED_TRACE(entry.path().string());
    std::ifstream in(entry.path());
    const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    const auto model = urdf::parseURDF(text);
    ASSERT_TRUE(model);
    Diagnostics diagnostics;
    check_file(entry.path(), diagnostics);
    EXPECT_EQ(diagnostics.errors() + diagnostics.warnings(), 0U) << diagnostics.text();
    auto component = parse_urdf(text, "r.urdf", entry.path(), AnyFile(), diagnostics);
    ASSERT_TRUE(component && diagnostics.ok());
    for (const ComponentNode& node : component->nodes) {
      if (!node.joint) continue;
      const auto theirs = model->getJoint(node.name);
      ASSERT_TRUE(theirs) << node.name;
      if (node.joint->kind != JointKind::continuous) {
        EXPECT_EQ(node.joint->min_position, theirs->limits->lower);
        EXPECT_EQ(node.joint->max_position, theirs->limits->upper);
      }
      EXPECT_EQ(node.joint->max_velocity, theirs->limits->velocity);
    }
    auto root = std::make_shared<Component>();
    root->file = "cell.toml";
    ComponentNode holder;
    holder.name = "R";
    holder.abstract = AbstractReference{"r.urdf", true, {}, {}, {}};
    root->nodes.push_back(holder);
    const auto cell = Cell::build(root, std::make_shared<OneFile>(std::move(*component)), diagnostics);
    ASSERT_TRUE(cell) << diagnostics.text();
    const RobotModel& robot = *cell->robot(std::size_t{0});
    std::mt19937 random(17);
    for (int round = 0; round < 20; ++round) {
      std::vector<JointValues> q = cell->start_positions();
      std::map<std::string, double> theirs;
      for (std::size_t i = 0; i < robot.joint_count(); ++i) {
        const auto& p = robot.parameters();
        q[0][i] = std::uniform_real_distribution<double>(p.min_range[i], p.max_range[i])(random);
        theirs[robot.joints()[i].name] = q[0][i];
      }
      for (const auto& [name, link] : model->links_) {
        const auto node = cell->find("R." + name);
        ASSERT_TRUE(node) << node.error().text();
        EXPECT_TRUE(cell->world_pose(*node, q).isApprox(link_pose(*model, name, theirs), 1e-9)) << name;
      }
    }
    ++compared;
  }
  EXPECT_GT(compared, 0);
}

}  // namespace
}  // namespace cellmirror
