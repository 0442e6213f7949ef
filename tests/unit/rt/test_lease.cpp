#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "rt_core/rt/allocation_guard.hpp"
#include "rt_core/rt/fifo.hpp"
#include "rt_core/rt/lease.hpp"

namespace cellmirror {
namespace {

TEST(Lease, KeepsTheObjectUntilItCameBackAndWasCollected) {
  Lender sut;
  auto object = std::make_shared<const int>(7);
  const std::weak_ptr<const int> watched = object;
  Lease<const int> lease = sut.lend(std::move(object));
  ASSERT_TRUE(lease);
  EXPECT_EQ(*lease, 7);
  EXPECT_EQ(sut.collect(), 0U);
  EXPECT_EQ(sut.outstanding(), 1U);
  lease.give_back();
  EXPECT_FALSE(lease);
  EXPECT_FALSE(watched.expired()) << "only the owner frees";
  EXPECT_EQ(sut.collect(), 1U);
  EXPECT_TRUE(watched.expired());
  EXPECT_EQ(sut.outstanding(), 0U);
}

TEST(Lease, OfNothingComesOfNothing) {
  Lender sut;
  const Lease<int> lease = sut.lend(std::shared_ptr<int>());
  EXPECT_FALSE(lease);
  EXPECT_EQ(lease.get(), nullptr);
  EXPECT_EQ(sut.outstanding(), 0U);
}

TEST(Lease, MovesAndEndsOnce) {
  Lender sut;
  {
    Lease<const int> first = sut.lend(std::make_shared<const int>(1));
    Lease<const int> second = std::move(first);
    EXPECT_EQ(*second, 1);
    second = sut.lend(std::make_shared<const int>(2));  // ends the one before
    EXPECT_EQ(sut.collect(), 1U);
    Lease<const int>& same = second;
    second = std::move(same);
    EXPECT_EQ(*second, 2);
    EXPECT_EQ(sut.collect(), 0U);
  }
  EXPECT_EQ(sut.collect(), 1U);
  EXPECT_EQ(sut.outstanding(), 0U);
}

TEST(Lease, ManyComeBackInAnyOrderAndAreFreed) {
  Lender sut;
  const auto object = std::make_shared<const int>(3);
  for (int round = 0; round < 3; ++round) {
    std::vector<Lease<const int>> leases;
    for (int i = 0; i < 100; ++i) leases.push_back(sut.lend(object));
    for (std::size_t i = 0; i < leases.size(); i += 2) leases[i].give_back();
    EXPECT_EQ(sut.collect(), 50U);
    leases.clear();
    EXPECT_EQ(sut.collect(), 50U);
    EXPECT_EQ(object.use_count(), 1);
  }
}

TEST(Lease, TravelsThroughAQueueAndIsGivenBackWithoutTouchingTheHeap) {
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  Lender sut;
  Fifo<Lease<const int>, 2> queue;
  Lease<const int> sent = sut.lend(std::make_shared<const int>(4));
  Lease<const int> refused = sut.lend(std::make_shared<const int>(5));
  {
    const AllocationGuard guard;
    ASSERT_TRUE(queue.push_from(sent));
    EXPECT_FALSE(sent);
    Lease<const int> nothing;
    ASSERT_TRUE(queue.push_from(nothing));
    EXPECT_FALSE(queue.push_from(refused));
    EXPECT_TRUE(refused) << "it is untouched where the queue is full";
    Lease<const int> taken;
    ASSERT_TRUE(queue.pop(taken));
    EXPECT_EQ(*taken, 4);
    taken.give_back();
    EXPECT_EQ(guard.allocations(), 0U);
    EXPECT_EQ(guard.frees(), 0U);
  }
  EXPECT_EQ(sut.collect(), 1U);
  refused.give_back();
}

TEST(Lease, LenderThatEndsBeforeItsLeasesBreaksTheContract) {
  EXPECT_DEATH(
      {
        auto sut = std::make_unique<Lender>();
        Lease<const int> lease = sut->lend(std::make_shared<const int>(1));
        sut.reset();
      },
      "contract broken");
}

}  // namespace
}  // namespace cellmirror
