#include "app/volume_info/volume_summary.hpp"

#include <gtest/gtest.h>

namespace cellmirror::app {
namespace {

// 4 x 3 x 2 voxels; the value is 100 i + 10 j + k.
VoxelGrid small_grid() {
  VoxelGrid grid;
  grid.size = {4, 3, 2};
  std::vector<std::int16_t> values;
  for (int k = 0; k < 2; ++k) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 4; ++i) values.push_back(static_cast<std::int16_t>(100 * i + 10 * j + k));
    }
  }
  grid.values = std::move(values);
  return grid;
}

TEST(VolumeSummary, IsInTheUnitOfTheGrid) {
  VoxelGrid grid = small_grid();
  grid.slope = -2;
  grid.intercept = 5;
  const VolumeSummary sut = summarise(grid);
  EXPECT_EQ(sut.least, -2 * 321 + 5);
  EXPECT_EQ(sut.most, 5);
  EXPECT_NEAR(sut.mean, -2 * 160.5 + 5, 1e-9);
  EXPECT_LE(sut.percent_1, sut.percent_50);
  EXPECT_LE(sut.percent_50, sut.percent_99);
}

TEST(VolumeSummary, CountsMaterialsByTheirHounsfieldUnits) {
  VoxelGrid grid;
  grid.size = {2, 2, 2};
  grid.hounsfield = true;
  grid.values = std::vector<std::int16_t>{-1000, -501, -500, -11, -10, 199, 200, 900};
  const MaterialShares sut = material_shares(grid, summarise(grid));
  EXPECT_DOUBLE_EQ(sut.air, 0.25);
  EXPECT_DOUBLE_EQ(sut.fat, 0.25);
  EXPECT_DOUBLE_EQ(sut.tissue, 0.25);
  EXPECT_DOUBLE_EQ(sut.bone, 0.25);
}

TEST(MiddleSliceOfVolume, HasTheOtherAxesAndItsWindow) {
  const VoxelGrid grid = small_grid();
  const GreyWindow window{160, 320};
  const MiddleSlice z = middle_slice(grid, 2, window);
  EXPECT_EQ(z.width, 4);
  EXPECT_EQ(z.height, 3);
  // k = 1; value 100 i + 10 j + 1 from 0 to 320.
  EXPECT_EQ(z.grey[0], 1);            // 1 / 320
  EXPECT_EQ(z.grey[3 + 4 * 1], 248);  // 311 / 320
  EXPECT_EQ(z.grey[3 + 4 * 2], 255);  // beyond
  const MiddleSlice x = middle_slice(grid, 0, window);
  EXPECT_EQ(x.width, 3);
  EXPECT_EQ(x.height, 2);
  EXPECT_EQ(x.grey[2 + 3 * 1], 176);  // i = 2, j = 2, k = 1: 221 / 320
}

}  // namespace
}  // namespace cellmirror::app
