#include "app/wall/wall_document.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/unit/wall/wall_messages.hpp"

namespace cellmirror::app {
namespace {

using nlohmann::json;

class WallDocument : public testing::Test {
 protected:
  json changes(double time_s) { return json::parse(sut.changes(cells, thumbnails, at(time_s))); }

  WallCells cells{WallSettings()};
  Thumbnails thumbnails{{}};
  WallDocuments sut{"1.2.3"};
};

TEST_F(WallDocument, TellsOnlyWhatHasChanged) {
  TestGateway a{"s1", "A"};
  TestGateway b{"s2", "B"};
  tell(cells, a, 0);
  tell(cells, b, 0);
  const json first = changes(0.25);
  EXPECT_EQ(first["from"], 0);
  EXPECT_EQ(first["to"], 1);
  ASSERT_EQ(first["tiles"].size(), 2u);
  EXPECT_EQ(first["tiles"][0]["content"]["cell"], "A");
  EXPECT_NEAR(first["tiles"][0]["pulse"]["age_s"].get<double>(), 0.25, 1e-9);
  tell(cells, a, 0.5);
  const json second = changes(0.5);
  ASSERT_EQ(second["tiles"].size(), 1u) << "B said nothing new";
  EXPECT_FALSE(second["tiles"][0].contains("content")) << "what A is has not changed";
  EXPECT_EQ(second["tiles"][0]["pulse"]["sequence"], 2);
  a.health = CellHealth::attention;
  tell(cells, a, 1);
  const json third = changes(1);
  EXPECT_EQ(third["tiles"][0]["content"]["state"], "attention");
  EXPECT_EQ(third["tiles"][0]["content"]["reasons"], json::array({"a reason"}));
  EXPECT_TRUE(changes(1.1)["tiles"].empty());
}

TEST_F(WallDocument, TellsSilenceWithItsBeginning) {
  TestGateway a{"s1", "A"};
  tell(cells, a, 0);
  static_cast<void>(changes(0));
  cells.look(at(4));
  const json document = changes(4);
  ASSERT_EQ(document["tiles"].size(), 1u);
  EXPECT_EQ(document["tiles"][0]["content"]["state"], "silent");
  EXPECT_EQ(document["tiles"][0]["content"]["level"], "fault");
  EXPECT_EQ(document["tiles"][0]["content"]["silent_since_ms"].get<double>(), 1e-6 * static_cast<double>(wall_at(0)));
}

TEST_F(WallDocument, NamesTilesThatAreGone) {
  // Two processes that say that they are the same gateway of the same cell; the first ends.
  TestGateway first{"s1", "A"};
  TestGateway second{"s2", "A"};
  second.run = "2";
  tell(cells, first, 0);
  tell(cells, second, 0.5);
  tell(cells, first, 1);
  EXPECT_EQ(changes(1)["tiles"].size(), 2u);
  tell(cells, second, 4.5);
  cells.look(at(4.5));
  EXPECT_EQ(changes(4.5)["removed"].size(), 1u);
}

TEST_F(WallDocument, TheWholeGoesOnWithTheNextChanges) {
  TestGateway a{"s1", "A"};
  tell(cells, a, 0);
  static_cast<void>(changes(0));
  const json whole = json::parse(sut.whole(cells, thumbnails, at(0.1)));
  EXPECT_EQ(whole["version"], "1.2.3");
  ASSERT_EQ(whole["tiles"].size(), 1u);
  EXPECT_EQ(whole["tiles"][0]["content"]["robots"][0]["state"], "fresh");
  EXPECT_EQ(changes(0.2)["from"], whole["to"]);
}

TEST_F(WallDocument, TextsThatAreNotUtf8AreReplaced) {
  TestGateway a{"s1", "A\xff"};
  tell(cells, a, 0);
  EXPECT_EQ(changes(0)["tiles"][0]["content"]["cell"], "A\xEF\xBF\xBD");
}

}  // namespace
}  // namespace cellmirror::app
