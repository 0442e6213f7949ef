#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror {
namespace {

constexpr double kRelativeError = 1.0 / 64.0;

// The definition, on all the data.
std::int64_t exact_percentile(std::vector<std::int64_t> data, double percent) {
  std::sort(data.begin(), data.end());
  const auto rank = static_cast<std::size_t>(std::ceil(percent / 100.0 * static_cast<double>(data.size())));
  return data[std::clamp<std::size_t>(rank, 1, data.size()) - 1];
}

void expect_percentiles_of(const std::vector<std::int64_t>& data) {
  const auto sut = std::make_unique<LatencyHistogram>();
  for (const std::int64_t ns : data) {
    sut->record(Nanoseconds(ns));
  }
  EXPECT_EQ(sut->count(), data.size());
  EXPECT_EQ(sut->max().count(), *std::max_element(data.begin(), data.end()));
  for (const double percent : {0.0, 1.0, 25.0, 50.0, 90.0, 99.0, 99.9, 99.99, 100.0}) {
    const auto exact = static_cast<double>(exact_percentile(data, percent));
    const auto found = static_cast<double>(sut->percentile(percent).count());
    EXPECT_GE(found, exact) << percent;
    EXPECT_LE(found, exact * (1.0 + kRelativeError)) << percent;
  }
}

TEST(LatencyBuckets, EveryBucketEndsWhereTheNextBegins) {
  for (std::size_t i = 0; i + 1 < LatencyBuckets::kCount; ++i) {
    const Nanoseconds last = LatencyBuckets::upper_bound(i);
    if (last >= LatencyBuckets::kLongest) {
      break;
    }
    ASSERT_EQ(LatencyBuckets::index(last), i);
    ASSERT_EQ(LatencyBuckets::index(last + Nanoseconds{1}), i + 1);
  }
}

TEST(LatencyBuckets, NoBucketIsWiderThanTheStatedError) {
  for (std::size_t i = 1; i < LatencyBuckets::kCount; ++i) {
    const auto lowest = static_cast<double>(LatencyBuckets::upper_bound(i - 1).count() + 1);
    const auto highest = static_cast<double>(LatencyBuckets::upper_bound(i).count());
    ASSERT_LE((highest - lowest) / lowest, kRelativeError) << i;
  }
}

TEST(LatencyBuckets, WhatIsOutOfRangeFallsIntoTheOutermostBuckets) {
  EXPECT_EQ(LatencyBuckets::index(Nanoseconds{-5}), 0U);
  EXPECT_EQ(LatencyBuckets::index(Nanoseconds::max()), LatencyBuckets::index(LatencyBuckets::kLongest));
  EXPECT_LT(LatencyBuckets::index(LatencyBuckets::kLongest), LatencyBuckets::kCount);
}

TEST(LatencyHistogram, IsZeroWhileEmpty) {
  const LatencyHistogram sut;
  EXPECT_EQ(sut.count(), 0U);
  EXPECT_EQ(sut.percentile(50).count(), 0);
  EXPECT_EQ(sut.max().count(), 0);
  EXPECT_EQ(sut.snapshot().mean().count(), 0);
}

TEST(LatencyHistogram, PercentilesAgreeWithSortedDataUniform) {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::int64_t> distribution(0, 5'000'000);
  std::vector<std::int64_t> data(100'000);
  std::generate(data.begin(), data.end(), [&] { return distribution(random); });
  expect_percentiles_of(data);
}

TEST(LatencyHistogram, PercentilesAgreeWithSortedDataLongTailed) {
  std::mt19937_64 random(2);
  std::lognormal_distribution<double> distribution(10.0, 2.0);
  std::vector<std::int64_t> data(100'000);
  std::generate(data.begin(), data.end(),
                [&] { return static_cast<std::int64_t>(std::min(distribution(random), 9.9e10)); });
  expect_percentiles_of(data);
}

TEST(LatencyHistogram, PercentilesAgreeWithSortedDataFewValues) {
  expect_percentiles_of({17});
  expect_percentiles_of({1, 100'000'000'000});
  expect_percentiles_of({127, 128, 129, 255, 256});
}

TEST(LatencyHistogram, KeepsTheTrueMaximumBeyondItsRange) {
  LatencyHistogram sut;
  sut.record(Nanoseconds{250'000'000'000});
  EXPECT_EQ(sut.max().count(), 250'000'000'000);
  EXPECT_EQ(sut.count(), 1U);
}

TEST(LatencyHistogram, NegativeDurationsCountAsZero) {
  LatencyHistogram sut;
  sut.record(Nanoseconds{-1});
  EXPECT_EQ(sut.percentile(100).count(), 0);
  EXPECT_EQ(sut.snapshot().mean().count(), 0);
}

TEST(LatencyHistogram, AResetShowsAtOnceAndLaterRecordsStartAnew) {
  LatencyHistogram sut;
  sut.record(Nanoseconds{1'000'000});
  sut.request_reset();
  EXPECT_EQ(sut.count(), 0U);
  sut.record(Nanoseconds{5});
  EXPECT_EQ(sut.count(), 1U);
  EXPECT_EQ(sut.max().count(), 5);
  EXPECT_EQ(sut.percentile(100).count(), 5);
}

TEST(HistogramSnapshot, MergedEqualsRecordedTogether) {
  LatencyHistogram a;
  LatencyHistogram b;
  LatencyHistogram together;
  std::mt19937_64 random(3);
  std::lognormal_distribution<double> distribution(9.0, 1.0);
  for (int i = 0; i < 10'000; ++i) {
    const Nanoseconds duration(static_cast<std::int64_t>(distribution(random)));
    (i % 3 == 0 ? a : b).record(duration);
    together.record(duration);
  }
  HistogramSnapshot sut = a.snapshot();
  sut.merge(b.snapshot());
  EXPECT_EQ(sut.count(), 10'000U);
  EXPECT_EQ(sut.max(), together.max());
  EXPECT_EQ(sut.mean(), together.snapshot().mean());
  for (const double percent : {10.0, 50.0, 99.0, 99.9}) {
    EXPECT_EQ(sut.percentile(percent), together.percentile(percent));
  }
}

TEST(HistogramSnapshot, CountsWhatIsAboveALimit) {
  LatencyHistogram histogram;
  for (int us = 1; us <= 100; ++us) {
    histogram.record(Nanoseconds{us * 1000});
  }
  const HistogramSnapshot sut = histogram.snapshot();
  EXPECT_EQ(sut.count_above(Nanoseconds{0}), 100U);
  EXPECT_EQ(sut.count_above(Nanoseconds{50'500}), 50U);
  EXPECT_EQ(sut.count_above(Nanoseconds{200'000}), 0U);
}

}  // namespace
}  // namespace cellmirror
