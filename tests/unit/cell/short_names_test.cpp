// Short names differ where paths do, and a cell finds by them what they were made of.
#include "rt_core/cell/short_names.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/unit/cell/cell_from_text.hpp"

namespace cellmirror {
namespace {

using Texts = std::vector<std::string>;

Texts of(const Texts& paths) { return short_names(paths, paths); }

TEST(ShortNames, LeaveOutTheMiddle) {
  EXPECT_EQ(of({"Floor", "A.J_1.J_2", "A.J_1.J_2.J_3", "B.J_1.J_2"}), (Texts{"Floor", "A.J_2", "A.J_3", "B.J_2"}));
}

TEST(ShortNames, KeepOfTheMiddleWhatTellsApart) {
  EXPECT_EQ(of({"C.M.Left.N.Jaw", "C.M.Right.N.Jaw"}), (Texts{"C.Left.Jaw", "C.Right.Jaw"}));
  EXPECT_EQ(of({"C.x.L.Jaw", "C.y.R.Jaw", "D.x.R.Jaw", "D.y.L.Jaw"}),
            (Texts{"C.x.Jaw", "C.y.Jaw", "D.x.Jaw", "D.y.Jaw"}));
}

TEST(ShortNames, AreNotThoseOfWhatHasNoBody) {
  const Texts paths{"A.J_1.J_2"};
  EXPECT_EQ(short_names(paths, Texts{"A.J_1.J_2", "A.J_2"}), paths);
  EXPECT_EQ(short_names(paths, Texts{"A.J_1.J_2", "B.A.J_2"}), paths);
}

TEST(ShortNames, HaveRoomInARecord) {
  const auto part = [](char c) { return std::string(63, c); };
  const std::string top = part('a') + ".";
  const Texts names = of({top + part('l') + ".x." + part('z'), top + part('r') + ".x." + part('z')});
  EXPECT_EQ(names, (Texts{part('l') + "." + part('z'), part('r') + "." + part('z')}));
  EXPECT_EQ(names.front().size(), 127U);
}

TEST(ShortNames, NameTheirNodesInTheCell) {
  auto files = std::make_shared<TextFiles>();
  files->add("arm.mpc", kArm);
  files->add("hand.mpc", "[[node]]\nname = \"TIP\"\n[[node]]\nname = \"LIFT\"\nparent = \"TIP\"\n");
  Diagnostics diagnostics;
  const auto cell = build_cell(R"(
[[node]]
name = "Left"
abstract = "arm.mpc"
[[node]]
name = "Right"
abstract = "arm.mpc"
robot_id = "R"
[[node]]
name = "Spare"
[[node]]
name = "Left"
parent = "Spare"
abstract = "hand.mpc"
)",
                               files, diagnostics);
  ASSERT_TRUE(cell) << diagnostics.text();
  const auto picture = cell->compile();
  std::vector<std::int32_t> nodes;
  for (std::size_t i = 1; i < picture->size(); ++i) nodes.push_back(static_cast<std::int32_t>(i));
  const Texts names = short_body_names(*picture, nodes);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), nodes.size());
  std::size_t shorter = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::string& path = body_name(*picture, nodes[i]);
    const auto node = cell->find(names[i]);
    ASSERT_TRUE(node) << names[i];
    EXPECT_EQ(cell->path(*node), path) << names[i];
    shorter += names[i].size() < path.size() ? 1 : 0;
  }
  EXPECT_GE(shorter, 4U);
}

TEST(ShortNames, TheCellsOwnGeometryHasTheNameOfTheCell) {
  Component root;
  root.name = "bench";
  root.geometry.emplace_back();
  root.nodes.resize(2);
  root.nodes[0].name = "Left";
  root.nodes[1].name = "bench";
  root.nodes[1].parent = 0;
  Diagnostics diagnostics;
  const auto cell = Cell::build(std::make_shared<const Component>(root), std::make_shared<TextFiles>(), diagnostics);
  ASSERT_TRUE(cell) << diagnostics.text();
  EXPECT_EQ(body_name(*cell->compile(), 0), "bench");
  EXPECT_EQ(short_body_names(*cell->compile(), std::vector<std::int32_t>{0}), Texts{"bench"});
  EXPECT_EQ(cell->find_branch("bench").value_or(""), "bench") << "it wins over the shortened path";
  EXPECT_EQ(cell->find_branch("Left.bench").value_or(""), "Left.bench");
  EXPECT_FALSE(cell->find_branch(""));
  root.geometry.clear();
  const auto bare = Cell::build(std::make_shared<const Component>(root), std::make_shared<TextFiles>(), diagnostics);
  ASSERT_TRUE(bare) << diagnostics.text();
  EXPECT_EQ(bare->find_branch("bench").value_or(""), "Left.bench");
}

}  // namespace
}  // namespace cellmirror
