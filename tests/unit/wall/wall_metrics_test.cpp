#include "app/wall/wall_metrics.hpp"

#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "tests/unit/wall/wall_messages.hpp"

namespace cellmirror::app {
namespace {

TEST(WallMetrics, HaveEachSeriesOnce) {
  WallCells cells((WallSettings()));
  TestGateway one{"s1", "A\"\n", "h"};
  TestGateway two{"s2", "A\"\n", "h"};
  TestGateway three{"s3", "A\"\n", "h"};
  three.run = "2";
  for (int i = 0; i < 3; ++i) {
    tell(cells, one, i);
    tell(cells, two, i);
    tell(cells, three, i);
  }
  cells.look(at(2.1));
  std::istringstream text(wall_metrics(cells, {}, at(2.5)));
  std::set<std::string> seen;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with('#')) continue;
    const std::string series = line.substr(0, line.rfind(' '));
    EXPECT_TRUE(seen.insert(series).second) << series;
  }
  EXPECT_TRUE(seen.contains(R"(cellmirror_wall_cell_up{cell="A\"\n",host="h",instance="default",claim="1"})"));
  EXPECT_TRUE(seen.contains(
      R"(cellmirror_wall_cell_robots{cell="A\"\n",host="h",instance="default",claim="1",state="fresh"})"));
  EXPECT_TRUE(seen.contains("cellmirror_wall_received_total"));
}

TEST(WallMetrics, ASilentCellIsDownAndHasAnAge) {
  WallCells cells((WallSettings()));
  TestGateway a{"s1", "A"};
  tell(cells, a, 0);
  cells.look(at(10));
  const std::string text = wall_metrics(cells, {}, at(10));
  EXPECT_NE(text.find("cellmirror_wall_cell_up{cell=\"A\",host=\"host\",instance=\"default\",claim=\"1\"} 0\n"),
            std::string::npos);
  EXPECT_NE(
      text.find("cellmirror_wall_cell_age_seconds{cell=\"A\",host=\"host\",instance=\"default\",claim=\"1\"} 10\n"),
      std::string::npos);
  EXPECT_EQ(text.find("cellmirror_wall_cell_touching{"), std::string::npos) << "nobody knows";
}

}  // namespace
}  // namespace cellmirror::app
