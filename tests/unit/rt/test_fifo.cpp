#include <gtest/gtest.h>
#include <sys/resource.h>

#include <memory>

#include "rt_core/rt/fifo.hpp"

namespace cellmirror {
namespace {

TEST(Fifo, GivesBackInTheOrderOfPushing) {
  Fifo<int, 4> sut;
  for (int i = 1; i <= 3; ++i) {
    ASSERT_TRUE(sut.push(i));
  }
  EXPECT_EQ(sut.size(), 3U);
  int value = 0;
  for (int i = 1; i <= 3; ++i) {
    ASSERT_TRUE(sut.pop(value));
    EXPECT_EQ(value, i);
  }
}

TEST(Fifo, EmptyRefusesToPopAndLeavesTheValueAlone) {
  Fifo<int, 2> sut;
  int value = 77;
  EXPECT_FALSE(sut.pop(value));
  EXPECT_EQ(value, 77);
}

TEST(Fifo, HoldsItsWholeCapacityThenRefusesTheNewestAndCounts) {
  Fifo<int, 3> sut;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(sut.push(i));
  }
  EXPECT_FALSE(sut.push(100));
  EXPECT_FALSE(sut.push(101));
  EXPECT_EQ(sut.dropped(), 2U);
  EXPECT_EQ(sut.pushed(), 3U);
  int value = -1;
  ASSERT_TRUE(sut.pop(value));
  EXPECT_EQ(value, 0) << "what was inside stays";
  EXPECT_TRUE(sut.push(102)) << "a place is free again";
}

TEST(Fifo, WorksAcrossItsWrapAround) {
  Fifo<int, 3> sut;
  int value = -1;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(sut.push(i));
    ASSERT_TRUE(sut.push(i + 1000));
    ASSERT_TRUE(sut.pop(value));
    ASSERT_EQ(value, i);
    ASSERT_TRUE(sut.pop(value));
    ASSERT_EQ(value, i + 1000);
  }
}

TEST(Fifo, HighWaterIsTheLargestFillLevelEver) {
  Fifo<int, 8> sut;
  EXPECT_EQ(sut.high_water(), 0U);
  int value = 0;
  for (int i = 0; i < 5; ++i) {
    sut.push(i);
  }
  while (sut.pop(value)) {
  }
  sut.push(1);
  EXPECT_EQ(sut.high_water(), 5U);
  EXPECT_EQ(sut.capacity(), 8U);
}

TEST(Fifo, CarriesValuesLargerThanACacheLine) {
  struct Large {
    double values[100];
  };
  const auto sut = std::make_unique<Fifo<Large, 16>>();
  Large in{};
  in.values[99] = 3.5;
  ASSERT_TRUE(sut->push(in));
  Large out{};
  ASSERT_TRUE(sut->pop(out));
  EXPECT_EQ(out.values[99], 3.5);
}

TEST(Fifo, ItsFirstRoundMeetsNoPageFault) {
#ifdef CELLMIRROR_SANITIZED
  GTEST_SKIP() << "skipped: the sanitizers' own memory faults";
#endif
  struct Page {
    unsigned char bytes[4096];
  };
  const auto sut = std::make_unique<Fifo<Page, 256>>();
  const Page page{};
  rusage before{};
  getrusage(RUSAGE_THREAD, &before);
  while (sut->push(page)) {
  }
  rusage after{};
  getrusage(RUSAGE_THREAD, &after);
  // Storage that was never written would cost 256; a few are the kernel's own business.
  EXPECT_LT(after.ru_minflt - before.ru_minflt, 10);
}

}  // namespace
}  // namespace cellmirror
