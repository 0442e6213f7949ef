#include "rt_core/base/rate_meter.hpp"

#include <gtest/gtest.h>

namespace cellmirror {
namespace {

TEST(RateMeter, CountsTheLastSecond) {
  RateMeter sut;
  for (int i = 0; i < 3000; ++i) sut.count({i * 1'000'000LL});
  EXPECT_NEAR(sut.per_second({3'000'000'000}), 1000.0, 0.1);
  EXPECT_EQ(sut.per_second({5'000'000'000}), 0.0);
}

TEST(RateMeter, ForgetsSliceBySlice) {
  RateMeter sut;
  Timestamp now{5'000'000'000};
  for (int i = 0; i < 2000; ++i) {
    now = now + Nanoseconds(2'000'000);
    sut.count(now);
  }
  EXPECT_NEAR(sut.per_second(now), 500.0, 1.0);
  EXPECT_NEAR(sut.per_second(now + Nanoseconds(500'000'000)), 250.0, 51.0);
  EXPECT_EQ(sut.per_second(now + Nanoseconds(1'200'000'000)), 0.0);
  EXPECT_EQ(sut.per_second(now + Nanoseconds(100'000'000'000)), 0.0);
}

TEST(CounterRate, IsBetweenReadingsAWindowApart) {
  CounterRate sut(Nanoseconds(500'000'000));
  EXPECT_EQ(sut.read({1'000'000'000}, 70), 0.0);
  EXPECT_EQ(sut.read({1'400'000'000}, 470), 0.0);  // too early for a second reading
  EXPECT_NEAR(sut.read({1'500'000'000}, 570), 1000.0, 1e-9);
  EXPECT_NEAR(sut.read({1'999'000'000}, 570), 1000.0, 1e-9);
  EXPECT_NEAR(sut.read({2'500'000'000}, 570), 0.0, 1e-9);
  sut.read({3'000'000'000}, 1070);
  sut.restart();
  EXPECT_EQ(sut.read({3'100'000'000}, 1170), 0.0);
}

}  // namespace
}  // namespace cellmirror
