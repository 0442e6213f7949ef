#include "app/owner/volume/volume_histogram.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace cellmirror::app {
namespace {

std::uint64_t total(const VolumeHistogram& histogram) {
  return std::accumulate(histogram.counts.begin(), histogram.counts.end(), std::uint64_t{0});
}

VoxelGrid grid_of(VoxelGrid::Values values) {
  VoxelGrid grid;
  grid.values = std::move(values);
  return grid;
}

TEST(VolumeHistogram, CountsEachVoxelOfASmallVolumeInTheUnitOfItsValues) {
  VoxelGrid grid = grid_of(std::vector<std::int16_t>{-10, -10, 118, 54});
  grid.slope = 2;
  grid.intercept = -1000;
  const VolumeHistogram sut = histogram_of(grid);
  EXPECT_EQ(sut.low, -1020);
  EXPECT_EQ(sut.high, -764);
  EXPECT_EQ(sut.counts[0], 2U);
  EXPECT_EQ(sut.counts[64], 1U);
  EXPECT_EQ(sut.counts[127], 1U) << "the highest value is in the last bin";
  EXPECT_EQ(total(sut), 4U);
}

TEST(VolumeHistogram, TurnsAroundWithANegativeSlope) {
  VoxelGrid grid = grid_of(std::vector<std::uint8_t>{0, 0, 0, 128});
  grid.slope = -1;
  const VolumeHistogram sut = histogram_of(grid);
  EXPECT_EQ(sut.low, -128);
  EXPECT_EQ(sut.high, 0);
  EXPECT_EQ(sut.counts[127], 3U);
  EXPECT_EQ(sut.counts[0], 1U);
}

TEST(VolumeHistogram, OneValueOrNoneIsNoError) {
  const VolumeHistogram one = histogram_of(grid_of(std::vector<std::uint16_t>(100, 65535)));
  EXPECT_EQ(one.counts[0], 100U);
  EXPECT_EQ(one.low, 65535);
  EXPECT_EQ(total(histogram_of(grid_of(std::vector<std::uint16_t>()))), 0U);
}

TEST(VolumeHistogram, TheWholeRangeOfAKindFits) {
  const VolumeHistogram sut = histogram_of(grid_of(std::vector<std::int16_t>{-32768, 32767}));
  EXPECT_EQ(sut.counts[0], 1U);
  EXPECT_EQ(sut.counts[127], 1U);
}

TEST(VolumeHistogram, OfALargeVolumeASampleIsCounted) {
  const VolumeHistogram sut = histogram_of(grid_of(std::vector<std::uint8_t>(std::size_t{40} << 20U, 7)));
  EXPECT_GT(total(sut), std::uint64_t{3} << 20U);
  EXPECT_LE(total(sut), std::uint64_t{5} << 20U);
}

}  // namespace
}  // namespace cellmirror::app
