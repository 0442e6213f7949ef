#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "config/parse.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;
using testing::Not;

struct ComponentText : testing::Test {
  bool parse(const std::string& text) {
    diagnostics = {};
    sut = parse_component("format = 1\n" + text, "a.mpc", AnyFile(), diagnostics);
    return diagnostics.ok();
  }
  std::string findings() const { return diagnostics.text(); }
  const ComponentNode& node(std::size_t i) const { return sut->nodes.at(i); }
  std::optional<Component> sut;
  Diagnostics diagnostics;
};

TEST_F(ComponentText, readsShapes) {
  ASSERT_TRUE(parse(R"(geometry = [
  { box_m = [1, 2, 3] }, { cylinder_m = [1, 2] }, { sphere_m = 1 }, { capsule_m = [1, 2] },
  { mesh = "a.stl", scale = [1, 1, 2], xyz_m = [1, 0, 0], rpy_rad = [0, 0, 1.5], rgba = [1, 0, 0, 0.5], drawn = false },
])")) << findings();
  ASSERT_EQ(sut->geometry.size(), 5U);
  EXPECT_EQ(sut->geometry[0].size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(sut->geometry[1].shape, Shape::cylinder);
  EXPECT_EQ(sut->geometry[4].shape, Shape::mesh);
  EXPECT_EQ(sut->geometry[4].rgba[3], 0.5F);
  EXPECT_FALSE(sut->geometry[4].drawn);
}

TEST_F(ComponentText, readsNodesOfEveryKind) {
  ASSERT_TRUE(parse(R"(
[[node]]
name = "F"
xyz_m = [1, 2, 3]
body = { mass_kg = 2, center_m = [0, 0, 1], inertia_kg_m2 = [1, 2, 3, 0.1, 0.2, 0.3] }
[[node]]
name = "C"
parent = "F"
type = "camera"
camera = { focal_distance_m = 2, fovy_rad = 0.4 }
[[node]]
name = "S"
type = "sensor"
sensor = { range_m = 2, half_angle_rad = 0.1, blind_zone_m = 0.2 }
[[node]]
name = "W"
type = "workframe"
)")) << findings();
  EXPECT_EQ(node(0).inertia.I_C(0, 2), 0.2);
  EXPECT_EQ(node(1).parent, 0);
  EXPECT_EQ(node(1).camera.fovy_rad, 0.4);
  EXPECT_EQ(node(2).sensor.blind_zone_m, 0.2);
  EXPECT_EQ(node(3).kind, NodeKind::workframe);
}

TEST_F(ComponentText, readsARobotWithItsDrivesAndMimics) {
  ASSERT_TRUE(parse(R"(
[[node]]
name = "J"
joint = { type = "revolute", axis = [0, 3, 0], range_rad = [0.5, 1.5], velocity_rad_s = 2, gear_ratio = -100, rotor_inertia_kg_m2 = 0.001, effort_nm = 50 }
[[node]]
name = "K"
parent = "J"
joint = { type = "prismatic", axis = [0, 0, 1], mimic = { joint = "J", multiplier = -0.1, offset_m = 0.2 } }
[[node]]
name = "T"
parent = "K"
[robot]
id = "R"
flange = "T"
tool_center_point = { xyz_m = [0, 0, 0.1] }
)")) << findings();
  EXPECT_EQ(node(0).joint->axis, Eigen::Vector3d::UnitY());
  EXPECT_EQ(node(0).joint->start_position, 1.0) << "the middle where zero is outside";
  EXPECT_EQ(node(0).joint->drive.gear_ratio, -100.0);
  EXPECT_EQ(sut->robot->joints, std::vector<int>{0});
  EXPECT_EQ(sut->robot->flange, 2);
  EXPECT_EQ(sut->robot->parameters.max_acceleration[0], 10.0) << "full speed in 0.2 s";
  EXPECT_EQ(sut->robot->parameters.X_PT.translation().z(), 0.1);
}

TEST_F(ComponentText, parentsAreNamedByPathWhereNamesRepeat) {
  ASSERT_TRUE(
      parse("[[node]]\nname = \"A\"\n[[node]]\nname = \"X\"\nparent = \"A\"\n"
            "[[node]]\nname = \"B\"\n[[node]]\nname = \"X\"\nparent = \"B\"\n"
            "[[node]]\nname = \"Y\"\nparent = \"B.X\"\n"))
      << findings();
  EXPECT_EQ(node(4).parent, 3);
  EXPECT_FALSE(
      parse("[[node]]\nname = \"A\"\n[[node]]\nname = \"X\"\nparent = \"A\"\n"
            "[[node]]\nname = \"B\"\n[[node]]\nname = \"X\"\nparent = \"B\"\n"
            "[[node]]\nname = \"Y\"\nparent = \"X\"\n"));
  EXPECT_THAT(findings(), HasSubstr("name A.X or B.X"));
}

TEST_F(ComponentText, unitsOtherThanSiAreAnsweredWithTheValueInSi) {
  EXPECT_FALSE(parse("[[node]]\nname = \"A\"\nrpy_deg = [0, 90, 180]\nxyz_mm = [1, 2.5, 3]\n"));
  EXPECT_THAT(findings(), HasSubstr("write rpy_rad = [0, 1.57079633, 3.14159265]"));
  EXPECT_THAT(findings(), HasSubstr("write xyz_m = [0.001, 0.0025, 0.003]"));
}

TEST_F(ComponentText, findingsHaveLineAndColumn) {
  EXPECT_FALSE(parse("[[node]]\nname = \"A\"\n  xyz = [0, 0, 0]\n"));
  EXPECT_THAT(findings(), HasSubstr("a.mpc:4:3: error: node A: the key xyz is unknown; did you mean xyz_m?"));
}

TEST_F(ComponentText, numbersAreFiniteAndOfTheirType) {
  EXPECT_FALSE(parse("[[node]]\nname = \"A\"\nxyz_m = [nan, 0, 0]\n"));
  EXPECT_FALSE(parse("[[node]]\nname = \"A\"\nxyz_m = [0, inf, 0]\n"));
  EXPECT_FALSE(parse("[[node]]\nname = \"A\"\nxyz_m = [0, 0]\n"));
  EXPECT_FALSE(parse("[[node]]\nname = \"A\"\nxyz_m = \"0 0 0\"\n"));
  EXPECT_FALSE(parse("[[node]]\nname = \"A\"\nxyz_m = [0, 0, true]\n"));
  EXPECT_FALSE(parse("node = 3\n"));
  EXPECT_FALSE(parse("node = [3]\n"));
  EXPECT_FALSE(parse("robot = [[1]]\n"));
}

TEST_F(ComponentText, theFormatIsRequired) {
  sut = parse_component("", "a.mpc", AnyFile(), diagnostics);
  EXPECT_THAT(findings(), HasSubstr("the key format is missing"));
  diagnostics = {};
  sut = parse_component("format = 2", "a.mpc", AnyFile(), diagnostics);
  EXPECT_FALSE(diagnostics.ok());
}

TEST_F(ComponentText, whatIsNoTomlIsRefusedWithThePlace) {
  EXPECT_FALSE(parse("[[node]\n"));
  EXPECT_FALSE(sut);
  EXPECT_THAT(findings(), HasSubstr("a.mpc:2:"));
  EXPECT_FALSE(parse("[[node]]\n[!node]\n"));
  EXPECT_THAT(findings(), HasSubstr("a.mpc:3: error"));
  EXPECT_FALSE(parse(std::string("\0", 1)));
  EXPECT_FALSE(parse("a = " + std::string(100'000, '[')));
}

TEST_F(ComponentText, charactersOutsideOfAsciiStandInTextsAndCommentsOnly) {
  EXPECT_TRUE(parse("# T\xC3\xBCrk \xCC\xA2\ndescription = \"Tr\xC3\xA4ger \\\" \xCC\xA2 'x\" # \xC3\xA4\n"))
      << findings();
  EXPECT_TRUE(parse("description = '''\n\xC3\xA4\n\xCC\xA2'''\n")) << findings();
  EXPECT_FALSE(parse("description = \xCC\xA2\n"));
  EXPECT_THAT(findings(), HasSubstr("a.mpc:2:15: error: a character outside ASCII"));
  EXPECT_FALSE(parse("description = \"\"\"\\\n\xCC\xA2\"\"\"\n"));
}

// Each part of a dotted key is a nested table, which toml++ destroys recursively.
TEST_F(ComponentText, KeysWithTooManyPartsAreRefusedWithTheirPlace) {
  const auto key = [](int parts, const std::string& part, const std::string& dot) {
    std::string out = part;
    for (int i = 1; i < parts; ++i) out += dot + part;
    return out;
  };
  EXPECT_FALSE(parse(key(160'000, "a", ".") + " = 1\n"));
  EXPECT_THAT(findings(), HasSubstr("a.mpc:2:64: error: a key has more than 32 parts"));
  EXPECT_FALSE(parse("\n [" + key(160'000, "a", ".") + "]\n"));
  EXPECT_THAT(findings(), HasSubstr("a.mpc:3:66: error: a key has more than 32 parts"));
  for (const char* part : {"a", "\"a\"", "'a.b'"}) {
    for (const char* dot : {".", " . ", "\t.\t"}) {
      const std::string long_key = key(160'000, part, dot);
      for (const std::string& text : {long_key + " = 1", "[" + long_key + "]", "[[" + long_key + "]]",
                                      "a = { " + long_key + " = 1 }", "a = [[1], { b = 1, " + long_key + " = 1 }]"}) {
        EXPECT_FALSE(parse(text + "\n"));
        EXPECT_THAT(findings(), HasSubstr("a key has more than 32 parts")) << text.substr(0, 60);
      }
    }
  }
}

TEST_F(ComponentText, KeysWithTheHighestNumberOfPartsAreRead) {
  std::string key = "a";
  for (int i = 1; i < 32; ++i) key += ".a";
  parse(key + " = 1\n");
  EXPECT_THAT(findings(), Not(HasSubstr("parts")));
  EXPECT_FALSE(parse(key + ".a = 1\n"));
  EXPECT_THAT(findings(), HasSubstr("a key has more than 32 parts"));
  // Dots in strings, comments and numbers do not belong to a key.
  const std::string dots(200, '.');
  std::string numbers = "0.5";
  for (int i = 0; i < 100; ++i) numbers += ", 0.5";
  parse("# " + dots + "\ndescription = \"" + dots + "\"\nx = [" + numbers + "]\n");
  EXPECT_THAT(findings(), Not(HasSubstr("parts")));
}

TEST_F(ComponentText, ListsAndTablesNestedTooDeeplyAreRefusedWithTheirPlace) {
  const auto nested = [](int depth) { return "a = " + std::string(depth, '[') + std::string(depth, ']') + "\n"; };
  parse(nested(32));
  EXPECT_THAT(findings(), Not(HasSubstr("nested")));
  EXPECT_FALSE(parse(nested(33)));
  EXPECT_THAT(findings(), HasSubstr("a.mpc:2:"));
  EXPECT_THAT(findings(), HasSubstr("lists and tables are nested more than 32 deep"));
  std::string tables = "a = ";
  for (int i = 0; i < 100'000; ++i) tables += "{a=";
  EXPECT_FALSE(parse(tables));
  EXPECT_THAT(findings(), HasSubstr("lists and tables are nested more than 32 deep"));
  EXPECT_THAT(findings(), Not(HasSubstr("TOML_MAX")));
}

TEST_F(ComponentText, countsAreBounded) {
  std::string many;
  for (int i = 0; i < 17; ++i) {
    const std::string n = std::to_string(i);
    many += "[[node]]\nname = \"J" + n + "\"\n" + (i == 0 ? "" : "parent = \"J" + std::to_string(i - 1) + "\"\n") +
            "joint = { type = \"continuous\", axis = [0, 0, 1], velocity_rad_s = 1 }\n";
  }
  EXPECT_FALSE(parse(many + "[robot]\nid = \"R\"\nflange = \"J16\"\n"));
  EXPECT_THAT(findings(), HasSubstr("more than 16 joints"));
  EXPECT_FALSE(parse("[[node]]\nname = \"" + std::string(64, 'a') + "\"\n"));
  EXPECT_THAT(findings(), HasSubstr("1 to 63 characters"));
}

}  // namespace
}  // namespace cellmirror
