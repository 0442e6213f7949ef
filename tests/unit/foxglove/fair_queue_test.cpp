#include "ipc/foxglove/fair_queue.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace cellmirror::foxglove {
namespace {

Payload of_size(std::size_t bytes) { return std::make_shared<const std::string>(bytes, 'x'); }

TEST(FairQueue, GivesOutInOrderAndIsEmptyThen) {
  FairQueue sut;
  sut.open(3, 10);
  EXPECT_TRUE(sut.empty());
  EXPECT_FALSE(sut.pop());
  EXPECT_EQ(sut.push(3, 100, of_size(1)), 0U);
  EXPECT_EQ(sut.push(3, 200, of_size(2)), 0U);
  EXPECT_FALSE(sut.empty());
  const auto first = sut.pop();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->subscription, 3U);
  EXPECT_EQ(first->time_ns, 100U);
  EXPECT_EQ(first->payload->size(), 1U);
  EXPECT_EQ(sut.pop()->time_ns, 200U);
  EXPECT_TRUE(sut.empty());
}

TEST(FairQueue, LeavesOutTheOldestOfAFullQueue) {
  FairQueue sut;
  sut.open(1, 2);
  EXPECT_EQ(sut.push(1, 1, of_size(1)), 0U);
  EXPECT_EQ(sut.push(1, 2, of_size(1)), 0U);
  EXPECT_EQ(sut.push(1, 3, of_size(1)), 1U);
  EXPECT_EQ(sut.dropped(1), 1U);
  EXPECT_EQ(sut.pop()->time_ns, 2U);
}

TEST(FairQueue, BoundsBytesButTakesOneLongMessage) {
  FairQueue sut;
  sut.open(1, 1000);
  const Payload half = of_size(FairQueue::kMostBytes / 2);
  EXPECT_EQ(sut.push(1, 1, half), 0U);
  EXPECT_EQ(sut.push(1, 2, half), 0U);
  EXPECT_EQ(sut.push(1, 3, half), 1U);
  EXPECT_EQ(sut.push(1, 4, of_size(2 * FairQueue::kMostBytes)), 2U);
  EXPECT_EQ(sut.pop()->time_ns, 4U);
  EXPECT_TRUE(sut.empty());
}

TEST(FairQueue, GivesEachSubscriptionTheSameBytes) {
  FairQueue sut;
  sut.open(1, 1000);
  sut.open(2, 1000);
  for (int i = 0; i < 100; ++i) sut.push(1, 0, of_size(10'000));
  for (int i = 0; i < 1000; ++i) sut.push(2, 0, of_size(1000));
  std::map<std::uint32_t, std::size_t> bytes;
  for (int i = 0; i < 300; ++i) {
    const auto one = sut.pop();
    bytes[one->subscription] += one->payload->size();
  }
  EXPECT_NEAR(static_cast<double>(bytes[1]), static_cast<double>(bytes[2]), 25'000);
}

TEST(FairQueue, AnIdleSubscriptionSavesUpNothing) {
  FairQueue sut;
  sut.open(1, 1000);
  sut.open(2, 1000);
  for (int i = 0; i < 500; ++i) {
    sut.push(1, 0, of_size(1000));
    EXPECT_TRUE(sut.pop());
  }
  // The second one comes late: it is not ahead by half a megabyte, but takes turns.
  for (int i = 0; i < 10; ++i) {
    sut.push(1, 0, of_size(1000));
    sut.push(2, 0, of_size(1000));
  }
  int of_first = 0;
  for (int i = 0; i < 10; ++i) of_first += sut.pop()->subscription == 1 ? 1 : 0;
  EXPECT_GE(of_first, 4);
  EXPECT_LE(of_first, 6);
}

TEST(FairQueue, ForgetsWhatIsClosed) {
  FairQueue sut;
  sut.open(1, 10);
  sut.push(1, 1, of_size(1));
  sut.close(1);
  EXPECT_TRUE(sut.empty());
  EXPECT_FALSE(sut.pop());
  EXPECT_EQ(sut.push(1, 1, of_size(1)), 0U);
  EXPECT_TRUE(sut.empty());
  sut.close(7);
}

}  // namespace
}  // namespace cellmirror::foxglove
