// Whoever is told of a pair of bodies can tell which bodies they are, however deep their nodes lie.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "app/report/status_collisions.hpp"
#include "app/subcommands/status_table_sensing.hpp"
#include "ipc/wire/proximity_record.hpp"
#include "rt_core/collision/pairs.hpp"
#include "tests/unit/cell/cell_from_text.hpp"

namespace cellmirror::app {
namespace {

// As a URDF arm of seven axes: its last link has a path of 177 bytes.
std::string deep_arm() {
  std::string text;
  std::string parent;
  const auto node = [&](const std::string& name, const char* more) {
    text += fmt::format("[[node]]\nname = \"{}\"\n", name);
    if (!parent.empty()) text += fmt::format("parent = \"{}\"\n", parent);
    text += std::string("xyz_m = [0.0, 0.0, 0.1]\n") + more;
    parent = name;
  };
  for (int axis = 0; axis < 8; ++axis) {
    if (axis > 0)
      node(fmt::format("arm_joint_{}", axis),
           "joint = { type = \"revolute\", axis = [0, 1, 0], range_rad = [-2.0, 2.0], velocity_rad_s = 2.0, "
           "acceleration_rad_s2 = 4.0 }\n");
    node(fmt::format("arm_link_{}", axis), "geometry = [{ name = \"link\", sphere_m = 0.04 }]\n");
  }
  return text + "[robot]\nid = \"ARM\"\nflange = \"arm_link_7\"\n";
}

struct TwoArms : testing::Test {
  TwoArms() {
    files->add("arm.mpc", deep_arm());
    Diagnostics diagnostics;
    cell = build_cell(R"(
geometry = [{ name = "table", box_m = [2.0, 2.0, 0.1] }]
[[node]]
name = "Left"
abstract = "arm.mpc"
[[node]]
name = "Right"
abstract = "arm.mpc"
robot_id = "OTHER"
xyz_m = [0.3, 0.0, 0.0]
)",
                      files, diagnostics);
    EXPECT_TRUE(cell) << diagnostics.text();
    table = collision::PairDerivation(std::make_shared<geometry::SolidLibrary>()).derive(*cell->compile(), {});
  }

  [[nodiscard]] ProximityState state_of(const collision::Pair& pair) const {
    ProximityState state;
    state.names = table->names;
    state.short_names = table->short_names;
    state.pairs = 1;
    TouchingPair touching;
    touching.a = pair.a;
    touching.b = pair.b;
    touching.depth_m = 0.01;
    state.touching.push_back(touching);
    return state;
  }

  std::shared_ptr<TextFiles> files = std::make_shared<TextFiles>();
  std::optional<Cell> cell;
  std::shared_ptr<const collision::PairTable> table;
};

using TwoNames = std::set<std::string>;

TEST_F(TwoArms, RecordsNameEveryPairDifferently) {
  ASSERT_EQ(table->bodies.size(), 17U);
  std::size_t longest = 0;
  for (const std::string& name : *table->names) longest = std::max(longest, name.size());
  ASSERT_GT(longest, 128U) << "else a record would have room for all paths";
  std::set<TwoNames> named;
  for (const collision::Pair& pair : table->pairs) {
    std::array<std::byte, 1024> bytes{};
    const auto length = encode_proximity_record(proximity_record_of(state_of(pair)), bytes);
    ASSERT_TRUE(length);
    const auto record = decode_proximity_record(std::span(bytes).first(*length));
    ASSERT_TRUE(record);
    const PairRecord& told = record->pairs.at(0);
    EXPECT_TRUE(named.insert({told.a, told.b}).second) << told.a << " - " << told.b;
    for (const auto& [name, body] : {std::pair(told.a, pair.a), std::pair(told.b, pair.b)}) {
      if (name == "world") continue;
      const auto node = cell->find(name);
      ASSERT_TRUE(node) << name;
      EXPECT_EQ(cell->path(*node), (*table->names)[body]);
    }
  }
  EXPECT_EQ(named.size(), table->pairs.size());
}

TEST_F(TwoArms, StatusShowsShortNamesAndKeepsThePaths) {
  CollisionReport report;
  report.active = true;
  for (const collision::Pair& pair : table->pairs) {
    if ((*table->short_names)[pair.b] != "Right.arm_link_7") continue;
    report.state = std::make_shared<const ProximityState>(state_of(pair));
    if (pair.a == 0) break;
  }
  ASSERT_TRUE(report.state);
  const nlohmann::json found = collisions_json(report, Timestamp{1});
  const nlohmann::json& pair = found.at("touching").at(0);
  EXPECT_EQ(pair.at("a"), "world") << "the cell's own geometry";
  EXPECT_EQ(pair.at("a_short"), "world");
  EXPECT_EQ(pair.at("b").get<std::string>().size(), 177U);
  EXPECT_EQ(pair.at("b_short"), "Right.arm_link_7");
  const std::string text = sensing_table({{"collisions", found}});
  EXPECT_NE(text.find("TOUCH world - Right.arm_link_7: 10.0 mm deep"), std::string::npos) << text;
}

}  // namespace
}  // namespace cellmirror::app
