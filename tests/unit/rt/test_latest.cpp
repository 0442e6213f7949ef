#include <gtest/gtest.h>

#include <vector>

#include "rt_core/rt/latest.hpp"

namespace cellmirror {
namespace {

TEST(Latest, BeforeTheFirstWriteReadsTheDefaultAsNotNew) {
  Latest<int> sut;
  const auto reading = sut.read();
  EXPECT_EQ(reading.value, 0);
  EXPECT_FALSE(reading.is_new);
  EXPECT_EQ(reading.sequence, 0U);
}

TEST(Latest, NewestWinsAndTheOthersAreCounted) {
  Latest<int> sut;
  for (int i = 1; i <= 5; ++i) {
    sut.write(i);
  }
  const auto reading = sut.read();
  EXPECT_EQ(reading.value, 5);
  EXPECT_TRUE(reading.is_new);
  EXPECT_EQ(reading.sequence, 5U);
  EXPECT_EQ(sut.published(), 5U);
  EXPECT_EQ(sut.overwritten(), 4U);
}

TEST(Latest, ReadingAgainGivesTheSameAsNotNew) {
  Latest<int> sut;
  sut.write(7);
  static_cast<void>(sut.read());
  const auto again = sut.read();
  EXPECT_EQ(again.value, 7);
  EXPECT_FALSE(again.is_new);
  EXPECT_EQ(again.sequence, 1U);
  EXPECT_EQ(sut.overwritten(), 0U);
}

TEST(Latest, AReadingStaysUnchangedWhileTheWriterGoesOn) {
  Latest<int> sut;
  sut.write(1);
  const auto reading = sut.read();
  for (int i = 2; i < 20; ++i) {
    sut.write(i);
    ASSERT_EQ(reading.value, 1);
  }
  EXPECT_EQ(sut.read().value, 19);
}

TEST(Latest, AlternatingWritesAndReadsLoseNothing) {
  Latest<int> sut;
  for (int i = 1; i < 1000; ++i) {
    sut.write(i);
    const auto reading = sut.read();
    ASSERT_EQ(reading.value, i);
    ASSERT_TRUE(reading.is_new);
  }
  EXPECT_EQ(sut.overwritten(), 0U);
}

TEST(Latest, IsFilledInPlaceAndShownOnlyOncePublished) {
  Latest<std::vector<int>> sut;
  sut.writable().assign(3, 9);
  EXPECT_FALSE(sut.read().is_new);
  sut.publish();
  const auto reading = sut.read();
  EXPECT_TRUE(reading.is_new);
  EXPECT_EQ(reading.value, (std::vector<int>{9, 9, 9}));
}

}  // namespace
}  // namespace cellmirror
