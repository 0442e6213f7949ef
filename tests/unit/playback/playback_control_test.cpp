// Where the playing of a recording is, by clocks that the test moves.
#include "app/playback/playback_control.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace cellmirror::app {
namespace {

constexpr Timestamp kFrom{1'000'000'000};
constexpr Timestamp kTo{11'000'000'000};
constexpr Nanoseconds kBeginUtc{1'700'000'000'000'000'000};
constexpr Timestamp kWall{5'000'000'000'000};

Nanoseconds s(double seconds) { return Nanoseconds(std::llround(1e9 * seconds)); }
std::int64_t utc(double behind_begin_s) { return (kFrom + kBeginUtc + s(behind_begin_s)).ns; }

class PlaybackControlTest : public testing::Test {
 protected:
  // It plays, with the first state there.
  void begin() { sut_.arrived(kFrom, kWall); }
  double at(double wall_s) { return seconds(sut_.due(kWall + s(wall_s)) - kFrom); }
  [[nodiscard]] PlaybackStatus status() const { return sut_.state().status; }

  PlaybackControl sut_{{.from = kFrom, .to = kTo, .utc = kBeginUtc}, "a.mcap", 1, true};
};

TEST_F(PlaybackControlTest, TimePassesAsOnTheWallOnceTheFirstStateIsThere) {
  EXPECT_EQ(status(), PlaybackStatus::seeking);
  EXPECT_EQ(at(3), 0);
  begin();
  EXPECT_EQ(status(), PlaybackStatus::playing);
  EXPECT_EQ(at(1.5), 1.5);
  EXPECT_EQ(sut_.clock().now(), kFrom + s(1.5));
  EXPECT_EQ(sut_.state().now_ns, utc(1.5));
  EXPECT_EQ(sut_.state().from_ns, utc(0));
  EXPECT_EQ(sut_.state().to_ns, utc(10));
}

TEST_F(PlaybackControlTest, TheClockNeverLeavesTheRange) {
  begin();
  EXPECT_EQ(at(25), 25) << "what is behind the end is due, too";
  EXPECT_EQ(sut_.clock().now(), kTo);
}

TEST_F(PlaybackControlTest, APauseKeepsTheTime) {
  begin();
  at(2);
  ASSERT_TRUE(sut_.apply({.play = false, .speed = {}, .seek_ns = {}}));
  EXPECT_EQ(status(), PlaybackStatus::paused);
  EXPECT_EQ(at(100), 2);
  ASSERT_TRUE(sut_.apply({.play = true, .speed = {}, .seek_ns = {}}));
  EXPECT_EQ(at(200), 2) << "counts from when it is looked at first";
  EXPECT_EQ(at(201), 3);
}

TEST_F(PlaybackControlTest, AnotherSpeedCountsFromWhereItIs) {
  begin();
  at(2);
  ASSERT_TRUE(sut_.apply({.play = {}, .speed = 4.0, .seek_ns = {}}));
  at(2);
  EXPECT_EQ(at(2.5), 4);
  EXPECT_EQ(sut_.state().speed, 4);
}

TEST_F(PlaybackControlTest, ASpeedThatIsNoneIsRefusedAndNothingElseIsDone) {
  begin();
  for (const double speed : {0.0, -1.0, 1e-4, 1e3, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_FALSE(sut_.apply({.play = false, .speed = speed, .seek_ns = utc(3)})) << speed;
  EXPECT_EQ(status(), PlaybackStatus::playing);
  EXPECT_EQ(sut_.state().changes, 1U) << "of begin()";
}

TEST_F(PlaybackControlTest, ASeekStandsThereUntilItsStateHasArrived) {
  begin();
  at(1);
  ASSERT_TRUE(sut_.apply({.play = {}, .speed = {}, .seek_ns = utc(7)}));
  EXPECT_TRUE(sut_.seek_waits());
  EXPECT_EQ(sut_.state().now_ns, utc(7)) << "told at once";
  EXPECT_EQ(sut_.take_seek(), kFrom + s(7));
  EXPECT_FALSE(sut_.take_seek());
  EXPECT_EQ(status(), PlaybackStatus::seeking);
  EXPECT_EQ(at(50), 7);
  sut_.arrived(kFrom + s(7), kWall + s(50));
  EXPECT_DOUBLE_EQ(at(50.5), 7.5);
  EXPECT_EQ(sut_.state().seeks, 1U);
}

TEST_F(PlaybackControlTest, SeeksAreMovedIntoTheRange) {
  begin();
  for (const auto& [wanted, expected] : {std::pair{std::numeric_limits<std::int64_t>::min(), kFrom},
                                         std::pair{std::numeric_limits<std::int64_t>::max(), kTo}}) {
    ASSERT_TRUE(sut_.apply({.play = {}, .speed = {}, .seek_ns = wanted}));
    EXPECT_EQ(sut_.take_seek(), expected);
  }
}

TEST_F(PlaybackControlTest, AGapIsJumpedOverAndTold) {
  begin();
  at(1);
  sut_.jumped(kFrom + s(4), kWall + s(1), "nothing was recorded");
  EXPECT_EQ(at(1.5), 4.5);
  EXPECT_EQ(sut_.state().gaps, 1U);
  EXPECT_EQ(sut_.state().note, "nothing was recorded");
}

TEST_F(PlaybackControlTest, AfterASeekIntoAGapTheTimeIsThatOfTheNextState) {
  begin();
  ASSERT_TRUE(sut_.apply({.play = false, .speed = {}, .seek_ns = utc(2)}));
  ASSERT_TRUE(sut_.take_seek());
  sut_.arrived(kFrom + s(4), kWall);
  EXPECT_EQ(at(9), 4);
  EXPECT_EQ(status(), PlaybackStatus::paused);
}

TEST_F(PlaybackControlTest, AtTheEndItStandsAndPlayBeginsAgain) {
  begin();
  sut_.ended();
  EXPECT_EQ(status(), PlaybackStatus::ended);
  EXPECT_EQ(sut_.state().now_ns, utc(10));
  EXPECT_EQ(at(50), 10);
  ASSERT_TRUE(sut_.apply({.play = true, .speed = {}, .seek_ns = {}}));
  EXPECT_EQ(sut_.take_seek(), kFrom);
  sut_.arrived(kFrom, kWall);
  EXPECT_EQ(status(), PlaybackStatus::playing);
}

TEST_F(PlaybackControlTest, FromTheEndASeekGoesWhereItIsAskedTo) {
  begin();
  sut_.ended();
  ASSERT_TRUE(sut_.apply({.play = true, .speed = {}, .seek_ns = utc(3)}));
  EXPECT_EQ(sut_.take_seek(), kFrom + s(3));
  sut_.arrived(kFrom + s(3), kWall);
  EXPECT_EQ(status(), PlaybackStatus::playing);
}

TEST_F(PlaybackControlTest, AnEndThatASeekHasOvertakenIsNone) {
  begin();
  ASSERT_TRUE(sut_.apply({.play = {}, .speed = {}, .seek_ns = utc(3)}));
  sut_.ended();
  EXPECT_EQ(sut_.take_seek(), kFrom + s(3));
}

TEST_F(PlaybackControlTest, WhatCannotBeReadEndsWithTheReason) {
  begin();
  sut_.failed("a chunk is not sound");
  EXPECT_EQ(status(), PlaybackStatus::ended);
  EXPECT_EQ(sut_.state().note, "a chunk is not sound");
  EXPECT_EQ(sut_.failure(), "a chunk is not sound");
  ASSERT_TRUE(sut_.apply({.play = {}, .speed = {}, .seek_ns = utc(3)}));
  ASSERT_TRUE(sut_.take_seek());
  EXPECT_EQ(sut_.failure(), "") << "elsewhere it may go on";
}

TEST_F(PlaybackControlTest, MarksWithinTheRangeAreInTheOrderOfTheirTimes) {
  EXPECT_EQ(sut_.state().marks, nullptr);
  sut_.set_marks({{utc(7), PlaybackMarkKind::fault, "lost"},
                  {utc(-0.1), PlaybackMarkKind::collision, "before"},
                  {utc(2), PlaybackMarkKind::collision, "a, b"},
                  {utc(10.1), PlaybackMarkKind::collision, "after"}});
  ASSERT_NE(sut_.state().marks, nullptr);
  const PlaybackMarks& marks = *sut_.state().marks;
  ASSERT_EQ(marks.size(), 2U);
  EXPECT_EQ(marks[0].text, "a, b");
  EXPECT_EQ(marks[1].text, "lost");
  sut_.set_marks(PlaybackMarks(2000, {utc(3), PlaybackMarkKind::fault, ""}));
  EXPECT_EQ(sut_.state().marks->size(), PlaybackControl::kMostMarks);
}

}  // namespace
}  // namespace cellmirror::app
