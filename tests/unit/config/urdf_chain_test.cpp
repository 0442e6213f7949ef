#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "config/parse.hpp"
#include "rt_core/cell/robot_chain.hpp"
#include "rt_core/kinematics/forward.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;

std::string links(const std::string& names) {
  std::string out;
  for (const char name : names)
    out += std::string("<link name=\"") + name + "\"><visual><geometry><mesh/></geometry></visual></link>\n";
  return out;
}

std::string joint(const std::string& name, char parent, char child, const std::string& more,
                  const std::string& type = "revolute") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/><origin xyz=\"1 0 0\"/><axis xyz=\"0 0 1\"/>" + more + "</joint>\n";
}

const std::string kLimit = R"(<limit lower="-1" upper="1"/>)";
const std::string kWrong = R"(<limit lower="1" upper="-1" velocity="x"/><mimic joint="nobody"/>)";

struct Parsed {
  std::optional<Component> component;
  Diagnostics diagnostics;
};

Parsed parse(const std::string& inside, const std::string& base, const std::string& tip) {
  Parsed out;
  out.component =
      parse_urdf_between("<robot name=\"r\">\n" + inside + "</robot>", "r.urdf", base, tip, out.diagnostics);
  return out;
}

std::vector<std::string> joints_of(const Parsed& parsed) {
  std::vector<std::string> out;
  for (const ComponentNode& node : parsed.component->nodes) {
    if (node.joint) out.push_back(node.name);
  }
  return out;
}

TEST(UrdfBetween, NeedsNoBodiesSpeedsAndEfforts) {
  const Parsed sut = parse(links("abc") + joint("j", 'a', 'b', kLimit) + joint("k", 'b', 'c', kLimit), "a", "c");
  ASSERT_TRUE(sut.diagnostics.ok()) << sut.diagnostics.text();
  EXPECT_THAT(joints_of(sut), testing::ElementsAre("j", "k"));
}

TEST(UrdfBetween, LeavesOutWhatIsOffTheWay) {
  const Parsed sut = parse(
      links("abcd") + joint("j", 'a', 'b', kLimit) + joint("k", 'b', 'c', kLimit) + joint("wrong", 'b', 'd', kWrong),
      "a", "c");
  ASSERT_TRUE(sut.diagnostics.ok()) << sut.diagnostics.text();
  EXPECT_THAT(joints_of(sut), testing::ElementsAre("j", "k"));
}

TEST(UrdfBetween, FindsWhatIsWrongOnTheWayWithItsLine) {
  const Parsed sut =
      parse(links("abcd") + joint("j", 'a', 'b', kLimit) + joint("k", 'b', 'c', R"(<limit lower="1" upper="-1"/>)"),
            "a", "c");
  EXPECT_THAT(sut.diagnostics.text(), HasSubstr("r.urdf:7: error: <limit>: lower 1 is not below upper -1"));
}

TEST(UrdfBetween, GoesUpAndDownAgain) {
  const Parsed sut = parse(links("abcd") + joint("root", 'a', 'b', kLimit) + joint("left", 'b', 'c', kLimit) +
                               joint("right", 'b', 'd', kLimit),
                           "c", "d");
  ASSERT_TRUE(sut.diagnostics.ok()) << sut.diagnostics.text();
  const auto chain = chain_between(*sut.component, "c", "d");
  ASSERT_TRUE(chain) << chain.error().text();
  EXPECT_EQ(chain->variable_count(), 2U);
}

TEST(UrdfBetween, KeepsAJointThatIsMimickedElsewhere) {
  const Parsed sut = parse(links("abcde") + joint("j", 'a', 'b', R"(<mimic joint="master" multiplier="2"/>)" + kLimit) +
                               joint("master", 'a', 'c', kLimit) + joint("wrong", 'c', 'd', kWrong),
                           "a", "b");
  ASSERT_TRUE(sut.diagnostics.ok()) << sut.diagnostics.text();
  EXPECT_THAT(joints_of(sut), testing::UnorderedElementsAre("j", "master"));
  const auto chain = chain_between(*sut.component, "a", "b");
  ASSERT_TRUE(chain) << chain.error().text();
  const double q[] = {0.25};
  const Pose X_BT = kinematics::forward(*chain, q);
  EXPECT_NEAR(std::atan2(X_BT(1, 0), X_BT(0, 0)), 0.5, 1e-12);
}

TEST(UrdfBetween, ReadsEverythingWhereTheLinksAreUnknownOrNoTree) {
  const std::string good = links("abc") + joint("j", 'a', 'b', kLimit);
  EXPECT_THAT(parse(good, "a", "c").diagnostics.text(), HasSubstr("c is a root link"));
  EXPECT_THAT(parse(good + joint("k", 'c', 'b', kLimit), "a", "c").diagnostics.text(), HasSubstr("two parents"));
  EXPECT_THAT(
      parse(links("abc") + joint("j", 'a', 'b', kLimit) + joint("k", 'b', 'a', kLimit), "a", "b").diagnostics.text(),
      HasSubstr("loop"));
  EXPECT_THAT(
      parse(links("ab") + joint("j", 'a', 'b', kLimit) + joint("j", 'a', 'x', kLimit), "a", "b").diagnostics.text(),
      HasSubstr("x is not a link"));
  const Parsed unknown = parse(links("ab") + joint("j", 'a', 'b', kLimit), "a", "z");
  ASSERT_TRUE(unknown.component);
  EXPECT_FALSE(chain_between(*unknown.component, "a", "z"));
}

TEST(UrdfBetween, TakesAHandOfManyJointsAtTheEndOfAnArm) {
  std::string inside = links("abc") + joint("j", 'a', 'b', kLimit) + joint("k", 'b', 'c', kLimit);
  for (int i = 0; i < 100; ++i) {
    const std::string name = "f" + std::to_string(i);
    inside += "<link name=\"" + name + "\"/>\n<joint name=\"" + name + "\" type=\"revolute\"><parent link=\"" +
              (i == 0 ? "c" : "f" + std::to_string(i - 1)) + "\"/><child link=\"" + name + "\"/>" + kLimit +
              "</joint>\n";
  }
  const Parsed sut = parse(inside, "a", "c");
  ASSERT_TRUE(sut.diagnostics.ok()) << sut.diagnostics.text();
  EXPECT_EQ(joints_of(sut).size(), 2U);
}

}  // namespace
}  // namespace cellmirror
