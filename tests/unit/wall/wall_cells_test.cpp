#include "app/wall/wall_cells.hpp"

#include <gtest/gtest.h>

#include "app/wall/wall_words.hpp"
#include "tests/unit/wall/wall_messages.hpp"

namespace cellmirror::app {
namespace {

WallSettings expecting(std::vector<WallCell> cells) {
  WallSettings settings;
  settings.cells = std::move(cells);
  return settings;
}

TEST(WallCells, ShowWhatGatewaysSay) {
  WallCells sut((WallSettings()));
  TestGateway a{"s1", "A"};
  TestGateway b{"s2", "B"};
  b.health = CellHealth::fault;
  tell(sut, a, 0);
  tell(sut, b, 0);
  sut.look(at(0.1));
  ASSERT_EQ(sut.tiles().size(), 2u);
  EXPECT_EQ(level_of(*tile_of(sut, "A")), CellHealth::ok);
  EXPECT_EQ(level_of(*tile_of(sut, "B")), CellHealth::fault);
  EXPECT_EQ(state_word(*tile_of(sut, "B")), "fault");
  EXPECT_TRUE(tile_of(sut, "A")->marks().empty());
}

TEST(WallCells, KeepASilentCellAndSaySinceWhen) {
  WallCells sut((WallSettings()));
  TestGateway a{"s1", "A"};
  tell(sut, a, 0);
  sut.look(at(2.9));
  EXPECT_TRUE(tile_of(sut, "A")->live);
  sut.look(at(3.1));
  const WallTile* tile = tile_of(sut, "A");
  ASSERT_NE(tile, nullptr);
  EXPECT_EQ(state_word(*tile), "silent");
  EXPECT_EQ(level_of(*tile), CellHealth::fault);
  EXPECT_EQ(tile->last_heard_wall_ns, wall_at(0));
  sut.look(at(100'000));
  EXPECT_NE(tile_of(sut, "A"), nullptr);
  tell(sut, a, 100'001);
  sut.look(at(100'001.1));
  EXPECT_EQ(state_word(*tile_of(sut, "A")), "ok");
  EXPECT_EQ(sut.tiles().size(), 1u);
}

TEST(WallCells, AWriterThatIsGoneIsSilentAtOnce) {
  WallCells sut((WallSettings()));
  TestGateway a{"s1", "A"};
  tell(sut, a, 0);
  sut.gone("s1");
  sut.gone("nobody");
  EXPECT_EQ(state_word(*tile_of(sut, "A")), "silent");
}

TEST(WallCells, ExpectedCellsAreThereBeforeTheyAreHeard) {
  WallCells sut(expecting({{.name = "A"}, {.name = "B"}}));
  TestGateway a{"s1", "A"};
  tell(sut, a, 0);
  EXPECT_EQ(state_word(*tile_of(sut, "A")), "ok");
  EXPECT_EQ(state_word(*tile_of(sut, "B")), "never seen");
  EXPECT_EQ(level_of(*tile_of(sut, "B")), CellHealth::fault);
  EXPECT_EQ(sut.tiles().size(), 2u);
}

TEST(WallCells, ACellThatNobodyExpectsIsMarked) {
  WallCells sut(expecting({{.name = "A"}}));
  TestGateway x{"s1", "X"};
  tell(sut, x, 0);
  EXPECT_TRUE(marked(tile_of(sut, "X"), WallMark::unexpected));
  EXPECT_EQ(level_of(*tile_of(sut, "X")), CellHealth::attention);
}

TEST(WallCells, WithoutAListNothingIsUnexpected) {
  WallCells sut((WallSettings()));
  TestGateway x{"s1", "X"};
  tell(sut, x, 0);
  EXPECT_TRUE(tile_of(sut, "X")->marks().empty());
}

TEST(WallCells, AGatewayOtherThanTheExpectedOneIsMarked) {
  WallCells sut(expecting({{.name = "A", .host = "right"}}));
  TestGateway liar{"s1", "A", "wrong"};
  tell(sut, liar, 0);
  EXPECT_TRUE(marked(tile_of(sut, "A", "s1"), WallMark::wrong_gateway));
  TestGateway own{"s2", "A", "right"};
  tell(sut, own, 1);
  sut.look(at(1.1));
  ASSERT_EQ(sut.tiles().size(), 2u) << "both are shown";
  EXPECT_FALSE(marked(tile_of(sut, "A", "s2"), WallMark::wrong_gateway));
  EXPECT_TRUE(marked(tile_of(sut, "A", "s2"), WallMark::conflict));
  EXPECT_TRUE(marked(tile_of(sut, "A", "s1"), WallMark::conflict));
}

TEST(WallCells, TwoGatewaysWithOneNameAreBothShownWhileBothAreThere) {
  WallCells sut((WallSettings()));
  TestGateway one{"s1", "A", "host-1"};
  TestGateway two{"s2", "A", "host-2"};
  for (int i = 0; i < 10; ++i) {
    tell(sut, one, i);
    tell(sut, two, i);
    sut.look(at(i + 0.1));
  }
  ASSERT_EQ(sut.tiles().size(), 2u);
  EXPECT_TRUE(marked(tile_of(sut, "A", "s1"), WallMark::conflict));
  EXPECT_NE(mark_text(*tile_of(sut, "A", "s2"), WallMark::conflict).find("host-2/default"), std::string::npos);
  for (int i = 10; i < 20; ++i) {
    tell(sut, two, i);
    sut.look(at(i + 0.1));
  }
  ASSERT_EQ(sut.tiles().size(), 2u) << "the death of one is shown";
  EXPECT_EQ(state_word(*tile_of(sut, "A", "s1")), "silent");
  EXPECT_EQ(level_of(*tile_of(sut, "A", "s1")), CellHealth::fault);
  EXPECT_EQ(state_word(*tile_of(sut, "A", "s2")), "ok");
  EXPECT_FALSE(marked(tile_of(sut, "A", "s2"), WallMark::conflict));
  sut.look(at(100'000));
  ASSERT_EQ(sut.tiles().size(), 2u) << "both are dead";
  TestGateway again{"s3", "A", "host-1"};
  again.run = "2";
  tell(sut, again, 100'001);
  sut.look(at(100'001.1));
  ASSERT_EQ(sut.tiles().size(), 2u);
  EXPECT_EQ(state_word(*tile_of(sut, "A", "s3")), "ok") << "it is back in its tile";
  EXPECT_EQ(state_word(*tile_of(sut, "A", "s2")), "silent");
}

TEST(WallCells, TheListedGatewayIsMissedEvenIfAnotherHasItsName) {
  WallCells sut(expecting({{.name = "A", .host = "right"}}));
  TestGateway own{"s1", "A", "right"};
  TestGateway other{"s2", "A", "wrong"};
  tell(sut, own, 0);
  tell(sut, other, 0);
  for (int i = 1; i < 10; ++i) {
    tell(sut, other, i);
    sut.look(at(i + 0.1));
  }
  ASSERT_EQ(sut.tiles().size(), 2u);
  EXPECT_EQ(state_word(*tile_of(sut, "A", "s1")), "silent");
  EXPECT_TRUE(marked(tile_of(sut, "A", "s2"), WallMark::wrong_gateway));
  own.sender = "s3";
  for (int i = 10; i < 20; ++i) {
    tell(sut, own, i);
    sut.look(at(i + 0.1));
  }
  ASSERT_EQ(sut.tiles().size(), 1u) << "the one that nobody listed is no loss";
  EXPECT_EQ(state_word(*tile_of(sut, "A", "s3")), "ok");
}

TEST(WallCells, FewDeadGatewaysOfOneNameAreKept) {
  WallCells sut(expecting({{.name = "A"}}));
  for (int i = 0; i < 100; ++i) {
    TestGateway claim{"s" + std::to_string(i), "A", "host-" + std::to_string(i)};
    tell(sut, claim, 0.001 * i);
  }
  sut.look(at(1));
  EXPECT_EQ(sut.tiles().size(), 100u);
  sut.look(at(10));
  EXPECT_EQ(sut.tiles().size(), WallCells::kMostDeadClaims);
}

TEST(WallCells, ARestartedGatewayTakesItsTile) {
  WallCells sut((WallSettings()));
  TestGateway first{"s1", "A"};
  tell(sut, first, 0);
  TestGateway again{"s2", "A"};
  again.run = "2";
  tell(sut, again, 0.5);
  sut.look(at(0.6));
  ASSERT_EQ(sut.tiles().size(), 1u);
  EXPECT_EQ(tile_of(sut, "A")->restarts, 1u);
  EXPECT_TRUE(tile_of(sut, "A")->marks().empty());
  tell(sut, first, 1);  // it was no restart: both send
  sut.look(at(1.1));
  EXPECT_EQ(sut.tiles().size(), 2u);
  EXPECT_TRUE(marked(tile_of(sut, "A", "s1"), WallMark::conflict));
  EXPECT_TRUE(marked(tile_of(sut, "A", "s2"), WallMark::conflict));
}

TEST(WallCells, ACellThatMovedToAnotherHostSaysFromWhere) {
  WallCells sut((WallSettings()));
  TestGateway first{"s1", "A", "old"};
  tell(sut, first, 0);
  sut.look(at(10));
  TestGateway moved{"s2", "A", "new"};
  tell(sut, moved, 10);
  sut.look(at(10.1));
  ASSERT_EQ(sut.tiles().size(), 1u);
  EXPECT_EQ(tile_of(sut, "A")->moved_from, "old/default");
  EXPECT_TRUE(tile_of(sut, "A")->marks().empty());
}

TEST(WallCells, ASenderThatChangesItsNameIsMarkedAndItsCellStays) {
  WallCells sut((WallSettings()));
  TestGateway liar{"s1", "A"};
  tell(sut, liar, 0);
  liar.cell = "B";
  tell(sut, liar, 0.5);
  EXPECT_EQ(state_word(*tile_of(sut, "A")), "silent");
  EXPECT_TRUE(marked(tile_of(sut, "B"), WallMark::renamed));
  EXPECT_EQ(tile_of(sut, "B")->called_before, "A");
}

TEST(WallCells, ASenderWithManyNamesHasFewTiles) {
  WallCells sut((WallSettings()));
  TestGateway liar{"s1", "name 0"};
  for (int i = 0; i < 100; ++i) {
    liar.cell = "name " + std::to_string(i);
    tell(sut, liar, 0.01 * i);
  }
  EXPECT_EQ(sut.tiles().size(), kMostNamesOfSender);
  EXPECT_EQ(sut.totals().left_out, 100 - kMostNamesOfSender);
  EXPECT_TRUE(marked(tile_of(sut, "name 3"), WallMark::renamed));
}

TEST(WallCells, GapsOfTheSequenceAreLost) {
  WallCells sut((WallSettings()));
  TestGateway a{"s1", "A"};
  tell(sut, a, 0);
  a.sequence += 5;
  tell(sut, a, 0.5);
  EXPECT_EQ(tile_of(sut, "A")->lost, 5u);
  a.sequence = 1;
  tell(sut, a, 1);
  EXPECT_EQ(tile_of(sut, "A")->repeated, 1u);
  a.sequence = ~std::uint64_t{0} - 5;
  tell(sut, a, 1.5);
  EXPECT_LT(tile_of(sut, "A")->lost, 2'000'000u) << "a number from outside is not believed";
}

TEST(WallCells, ANewerVersionIsMarked) {
  WallCells sut((WallSettings()));
  TestGateway a{"s1", "A"};
  a.version = kCellSummaryVersion + 1;
  tell(sut, a, 0);
  EXPECT_TRUE(marked(tile_of(sut, "A"), WallMark::newer_version));
}

TEST(WallCells, AClockThatDiffersChangesNoAge) {
  WallCells sut((WallSettings()));
  TestGateway a{"s1", "A"};
  a.clock_s = -3600;
  tell(sut, a, 0);
  sut.look(at(0.5));
  const WallTile* tile = tile_of(sut, "A");
  EXPECT_TRUE(tile->live);
  EXPECT_TRUE(marked(tile, WallMark::clock));
  EXPECT_EQ(mark_text(*tile, WallMark::clock), "its clock is 3600 s behind that of the wall");
  EXPECT_EQ(tile->last_heard, at(0));
}

TEST(WallCells, AFloodIsMarkedForAWhile) {
  WallCells sut((WallSettings()));
  TestGateway a{"s1", "A"};
  tell(sut, a, 0);
  sut.dropped("s1", 7, at(0));
  EXPECT_TRUE(marked(tile_of(sut, "A"), WallMark::flood));
  EXPECT_EQ(tile_of(sut, "A")->dropped, 7u);
  sut.look(at(11));
  EXPECT_FALSE(marked(tile_of(sut, "A"), WallMark::flood));
  EXPECT_EQ(sut.totals().dropped, 7u);
}

TEST(WallCells, WhatIsNoSummaryIsCountedWithItsSender) {
  WallCells sut((WallSettings()));
  TestGateway a{"s1", "A"};
  tell(sut, a, 0);
  sut.rejected("s1", 2, "no JSON");
  sut.rejected("nobody", 1, "garbage");
  EXPECT_EQ(tile_of(sut, "A")->rejected, 2u);
  EXPECT_EQ(mark_text(*tile_of(sut, "A"), WallMark::rejected), "some of what it sends is refused: no JSON");
  EXPECT_EQ(sut.totals().rejected, 3u);
  EXPECT_EQ(sut.totals().rejected_why, "garbage");
}

TEST(WallCells, AreBoundedAndLeaveExpectedOnesTheirPlace) {
  std::vector<WallCell> expected;
  for (int i = 0; i < 50; ++i) expected.push_back({.name = "expected " + std::to_string(i)});
  WallCells sut(expecting(expected));
  for (int i = 0; i < 3000; ++i) {
    TestGateway gateway{"s" + std::to_string(i), "cell " + std::to_string(i)};
    tell(sut, gateway, 0);
  }
  EXPECT_EQ(sut.tiles().size(), kMostWallTiles);
  EXPECT_EQ(sut.totals().left_out, 3000 - (kMostWallTiles - 50));
  TestGateway late{"s-late", "expected 7"};
  tell(sut, late, 0.1);
  EXPECT_EQ(state_word(*tile_of(sut, "expected 7")), "ok");
  sut.look(at(100));  // all are silent: who comes now takes the place of one of those
  TestGateway other{"s-other", "another"};
  tell(sut, other, 100);
  EXPECT_NE(tile_of(sut, "another"), nullptr);
  EXPECT_EQ(sut.tiles().size(), kMostWallTiles);
}

TEST(WallCells, RememberOverARestart) {
  WallCells before((WallSettings()));
  TestGateway a{"s1", "A", "host-1"};
  tell(before, a, 0);
  const auto kept = before.remembered();
  ASSERT_EQ(kept.size(), 1u);
  WallCells sut((WallSettings()));
  sut.remember(kept[0]);
  const WallTile* tile = tile_of(sut, "A");
  ASSERT_NE(tile, nullptr);
  EXPECT_EQ(state_word(*tile), "silent");
  EXPECT_EQ(tile->host, "host-1");
  EXPECT_EQ(tile->last_heard_wall_ns, wall_at(0));
  TestGateway again{"s2", "A", "host-1"};
  tell(sut, again, 50);
  sut.look(at(50.1));
  ASSERT_EQ(sut.tiles().size(), 1u);
  EXPECT_EQ(state_word(*tile_of(sut, "A")), "ok");
  EXPECT_TRUE(tile_of(sut, "A")->moved_from.empty());
}

}  // namespace
}  // namespace cellmirror::app
