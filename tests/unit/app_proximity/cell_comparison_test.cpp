// What differs between the same postures in two cells.
#include "app/proximity/cell_comparison.hpp"

#include <gtest/gtest.h>

#include <array>

namespace cellmirror::app {
namespace {

TEST(CellComparison, PairsThatTouchInOneCellAloneComeFirst) {
  CellOverPostures before{.cell = "a", .postures = 3};
  CellOverPostures after{.cell = "b", .postures = 3, .touching = 1};
  before.pairs[{"arm", "table"}] = {.nearest_m = 0.1, .nearest_at = 1};
  after.pairs[{"arm", "table"}] = {.nearest_m = 0.2, .nearest_at = 2};
  after.pairs[{"arm", "tool"}] = {.first_touch = 1, .deepest_m = 0.004, .nearest_m = 0};
  before.pairs[{"arm", "wall"}] = after.pairs[{"arm", "wall"}] = {.nearest_m = 0.3};
  const auto changes = compare(before, after);
  ASSERT_EQ(changes.size(), 2U);
  EXPECT_EQ(changes[0].bodies.second, "tool");
  EXPECT_EQ(changes[1].bodies.second, "table");
  const std::array<double, 3> times{10.0, 10.5, 11.0};
  const std::string text = comparison_text(before, after, times);
  EXPECT_NE(text.find("arm - tool: touch only in the other cell, from 10.50 s on, 4.0 mm deep"), std::string::npos);
  EXPECT_NE(text.find("arm - table: 0.200 m at 11.00 s instead of 0.100 m at 10.50 s"), std::string::npos) << text;
  EXPECT_NE(comparison_json(before, after, times, {}).find(R"("b":"tool","recorded":null)"), std::string::npos);
}

TEST(CellComparison, LessThanAMillimetreIsEqual) {
  CellOverPostures before;
  CellOverPostures after;
  before.pairs[{"arm", "table"}] = {.nearest_m = 0.1};
  after.pairs[{"arm", "table"}] = {.nearest_m = 0.1009};
  EXPECT_TRUE(compare(before, after).empty());
  EXPECT_NE(comparison_text(before, after, {}).find("no collision and no distance differs"), std::string::npos);
}

}  // namespace
}  // namespace cellmirror::app
