#include <gtest/gtest.h>

#include <vector>

#include "rt_core/rt/allocation_guard.hpp"
#include "rt_core/rt/broadcast.hpp"

namespace cellmirror {
namespace {

void put(Broadcast<int>& sut, int value) {
  sut.writable() = value;
  sut.publish();
}

TEST(Broadcast, BeforeTheFirstPublicationReadsTheInitialValueAsNotNew) {
  Broadcast<int> sut(5);
  EXPECT_FALSE(sut.has_readers());
  auto& reader = sut.subscribe();
  EXPECT_TRUE(sut.has_readers());
  const auto reading = reader.read();
  EXPECT_EQ(reading.value, 5);
  EXPECT_FALSE(reading.is_new);
  EXPECT_EQ(reading.sequence, 0U);
}

TEST(Broadcast, EachReaderReadsTheNewestAndCountsWhatItMissed) {
  Broadcast<int> sut;
  auto& quick = sut.subscribe();
  auto& slow = sut.subscribe();
  for (int i = 1; i <= 5; ++i) {
    put(sut, i);
    const auto reading = quick.read();
    EXPECT_EQ(reading.value, i);
    EXPECT_TRUE(reading.is_new);
  }
  const auto reading = slow.read();
  EXPECT_EQ(reading.value, 5);
  EXPECT_EQ(reading.sequence, 5U);
  EXPECT_EQ(quick.overwritten(), 0U);
  EXPECT_EQ(slow.overwritten(), 4U);
  EXPECT_FALSE(slow.read().is_new);
}

TEST(Broadcast, ReadingsStayUnchangedWhileTheWriterAndOtherReadersGoOn) {
  Broadcast<int> sut;
  auto& first = sut.subscribe();
  auto& second = sut.subscribe();
  auto& third = sut.subscribe();
  put(sut, 1);
  const auto held_by_first = first.read();
  put(sut, 2);
  const auto held_by_second = second.read();
  for (int i = 3; i < 50; ++i) {
    put(sut, i);
    if (i % 3 == 0) {
      ASSERT_EQ(third.read().value, i);
    }
    ASSERT_EQ(held_by_first.value, 1);
    ASSERT_EQ(held_by_second.value, 2);
  }
  EXPECT_EQ(first.read().value, 49);
}

TEST(Broadcast, TakesNoMemoryAfterItsReadersHaveSubscribed) {
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  Broadcast<std::vector<int>> sut(std::vector<int>(100));
  auto& reader = sut.subscribe();
  const AllocationGuard guard;
  for (int i = 1; i < 10; ++i) {
    sut.writable()[99] = i;
    sut.publish();
    ASSERT_EQ(reader.read().value[99], i);
  }
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST(Broadcast, SubscribingAfterTheFirstPublicationBreaksTheContract) {
  Broadcast<int> sut;
  put(sut, 1);
  EXPECT_DEATH(sut.subscribe(), "contract broken");
}

}  // namespace
}  // namespace cellmirror
