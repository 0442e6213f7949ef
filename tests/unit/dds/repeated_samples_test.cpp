#include "drivers/dds/internal/repeated_samples.hpp"

#include <gtest/gtest.h>

namespace cellmirror::dds {
namespace {

constexpr Nanoseconds kSecond{1'000'000'000};
constexpr Timestamp kStart{1'000 * kSecond.count()};

SampleName sample(std::uint8_t writer, std::int64_t number) {
  SampleName name;
  name.guid[0] = writer;
  name.number = number;
  return name;
}

TEST(RepeatedSamples, WithoutARestartNothingIsRefused) {
  RepeatedSamples repeated;
  for (const std::int64_t number : {5, 5, 4, 9, 1}) EXPECT_FALSE(repeated.is_repeated(sample(1, number), kStart));
}

TEST(RepeatedSamples, AfterARestartOnlyWhatIsLaterIsNew) {
  RepeatedSamples repeated;
  EXPECT_FALSE(repeated.is_repeated(sample(1, 5), kStart));
  repeated.restart(kStart);
  EXPECT_TRUE(repeated.is_repeated(sample(1, 5), kStart + kSecond));
  EXPECT_TRUE(repeated.is_repeated(sample(1, 2), kStart + kSecond));
  EXPECT_FALSE(repeated.is_repeated(sample(1, 6), kStart + kSecond));
  EXPECT_TRUE(repeated.is_repeated(sample(1, 5), kStart + kSecond)) << "also after a new one";
  EXPECT_FALSE(repeated.is_repeated(sample(2, 5), kStart + kSecond)) << "another writer";
  repeated.restart(kStart + 2 * kSecond);
  EXPECT_TRUE(repeated.is_repeated(sample(1, 6), kStart + 3 * kSecond)) << "and after a second restart";
}

TEST(RepeatedSamples, AWriterThatClosedIsForgottenAndNumbersAreWatchedForATime) {
  RepeatedSamples repeated;
  EXPECT_FALSE(repeated.is_repeated(sample(1, 5), kStart));
  EXPECT_FALSE(repeated.is_repeated(sample(2, 1'000'000'000'000), kStart)) << "a made-up number";
  repeated.forget(sample(1, 5).guid);
  repeated.restart(kStart);
  EXPECT_FALSE(repeated.is_repeated(sample(1, 5), kStart + kSecond));
  EXPECT_TRUE(repeated.is_repeated(sample(2, 7), kStart + kSecond));
  EXPECT_FALSE(repeated.is_repeated(sample(2, 7), kStart + RepeatedSamples::kWatched));
}

TEST(RepeatedSamples, SamplesWithoutANameAreNew) {
  RepeatedSamples repeated;
  repeated.restart(kStart);
  EXPECT_FALSE(repeated.is_repeated({}, kStart));
  EXPECT_FALSE(repeated.is_repeated({}, kStart));
}

TEST(RepeatedSamples, AFloodOfWritersIsBounded) {
  RepeatedSamples repeated;
  for (std::size_t i = 0; i < 3 * RepeatedSamples::kMostWriters; ++i) {
    SampleName name = sample(3, 1);
    name.guid[1] = static_cast<std::uint8_t>(i);
    name.guid[2] = static_cast<std::uint8_t>(i >> 8U);
    EXPECT_FALSE(repeated.is_repeated(name, kStart));
  }
  repeated.restart(kStart);
  EXPECT_FALSE(repeated.is_repeated(sample(4, 1), kStart));
}

}  // namespace
}  // namespace cellmirror::dds
