#include "rt_core/volume/bricks.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "rt_core/volume/coarse_grid.hpp"
#include "tests/support/volume/phantoms.hpp"

namespace cellmirror::volume {
namespace {

template <class T>
VoxelGrid random_grid(std::array<std::uint32_t, 3> size) {
  VoxelGrid grid;
  grid.size = size;
  std::mt19937 random(7);
  std::uniform_int_distribution<int> value(std::numeric_limits<T>::min(), std::numeric_limits<T>::max());
  std::vector<T> values(grid.count());
  for (T& v : values) v = static_cast<T>(value(random));
  grid.values = std::move(values);
  return grid;
}

template <class T>
void expect_bounds_of_all_cells(std::array<std::uint32_t, 3> size) {
  const VoxelGrid grid = random_grid<T>(size);
  const auto& values = std::get<std::vector<T>>(grid.values);
  const Bricks bricks = make_bricks(grid);
  std::vector<StoredRange> expected(bricks.ranges.size(), {1 << 20, -(1 << 20)});
  for (std::uint32_t k = 0; k < size[2]; ++k) {
    for (std::uint32_t j = 0; j < size[1]; ++j) {
      for (std::uint32_t i = 0; i < size[0]; ++i) {
        const int v = values[i + std::size_t{size[0]} * (j + std::size_t{size[1]} * k)];
        // A voxel belongs to the cells on both of its sides.
        for (unsigned corner = 0; corner < 8; ++corner) {
          const std::array<std::int64_t, 3> cell = {
              std::int64_t{i} - (corner & 1U), std::int64_t{j} - (corner >> 1U & 1U), std::int64_t{k} - (corner >> 2U)};
          std::size_t at = 0;
          bool inside = true;
          for (std::size_t axis = 3; axis-- > 0;) {
            inside = inside && cell[axis] >= 0 && cell[axis] < std::int64_t{size[axis]} - 1;
            at =
                at * bricks.count[axis] + static_cast<std::size_t>(std::max<std::int64_t>(cell[axis], 0) / kBrickCells);
          }
          if (!inside) continue;
          expected[at].low = std::min(expected[at].low, v);
          expected[at].high = std::max(expected[at].high, v);
        }
      }
    }
  }
  EXPECT_EQ(bricks.ranges, expected);
  // A block's range is that of the voxels up to 4 cells beyond it.
  const std::array<std::uint32_t, 3> blocks = {2 * bricks.count[0], 2 * bricks.count[1], 2 * bricks.count[2]};
  std::size_t block = 0;
  for (std::uint32_t z = 0; z < blocks[2]; ++z) {
    for (std::uint32_t y = 0; y < blocks[1]; ++y) {
      for (std::uint32_t x = 0; x < blocks[0]; ++x, ++block) {
        const auto within = [](std::uint32_t at, std::uint32_t of_block) {
          return at + kBlockCells >= of_block * kBlockCells && at <= (of_block + 2) * kBlockCells;
        };
        StoredRange near{1 << 20, -(1 << 20)};
        for (std::uint32_t k = 0; k < size[2]; ++k) {
          for (std::uint32_t j = 0; j < size[1]; ++j) {
            for (std::uint32_t i = 0; i < size[0]; ++i) {
              if (!within(i, x) || !within(j, y) || !within(k, z)) continue;
              const int v = values[i + std::size_t{size[0]} * (j + std::size_t{size[1]} * k)];
              near = {std::min(near.low, v), std::max(near.high, v)};
            }
          }
        }
        EXPECT_EQ((StoredRange{bricks.blocks.low[block] + bricks.blocks.bias,
                               bricks.blocks.high[block] + bricks.blocks.bias}),
                  near)
            << x << ' ' << y << ' ' << z;
      }
    }
  }
}

TEST(Bricks, RangesAreThoseOfTheirCells) {
  expect_bounds_of_all_cells<std::int16_t>({2, 2, 2});
  expect_bounds_of_all_cells<std::int16_t>({9, 8, 10});
  expect_bounds_of_all_cells<std::uint16_t>({17, 25, 16});
  expect_bounds_of_all_cells<std::uint8_t>({40, 3, 18});
}

// One opaque value, 1, of two.
std::vector<Appearance> table_of_ones() {
  std::vector<Appearance> table(2);
  table[1].extinction = 100;
  return table;
}

TEST(Bricks, LeapsAreTheDistanceToTheNextOccupiedBrick) {
  Bricks bricks;
  bricks.count = {20, 11, 7};
  bricks.ranges.resize(20 * 11 * 7);
  const std::array<std::array<int, 3>, 3> occupied = {{{3, 4, 2}, {0, 0, 6}, {19, 10, 0}}};
  for (const auto& [x, y, z] : occupied) bricks.ranges[static_cast<std::size_t>(x + 20 * (y + 11 * z))].high = 1;
  const LeapMap map = leaps_by_table(bricks, {0, 1}, table_of_ones(), {}, 1);
  EXPECT_EQ(map.occupied, 3U);
  for (int z = 0; z < 7; ++z) {
    for (int y = 0; y < 11; ++y) {
      for (int x = 0; x < 20; ++x) {
        int nearest = 100;
        for (const auto& [ox, oy, oz] : occupied)
          nearest = std::min(nearest, std::max({std::abs(x - ox), std::abs(y - oy), std::abs(z - oz)}));
        const int leap = map.leap[static_cast<std::size_t>(x + 20 * (y + 11 * z))] & 0xF;
        EXPECT_EQ(leap, std::min(nearest, 12));
      }
    }
  }
}

TEST(Bricks, StridesAreLongOnlyWhereABrickAndItsNeighboursAreThin) {
  Bricks bricks;
  bricks.count = {9, 1, 1};
  bricks.ranges.assign(9, {1, 1});
  bricks.ranges[4] = {1, 3};
  std::vector<Appearance> table(4);
  for (std::size_t i = 1; i < 4; ++i) table[i].extinction = static_cast<float>(i);
  const LeapMap map = leaps_by_table(bricks, {0, 3}, table, {2.5, 1.5, 0.5}, 1);
  // The same for all blocks of a brick, whose own ranges are not known here.
  for (int x = 0; x < 9; ++x) {
    EXPECT_EQ(map.leap[static_cast<std::size_t>(x)] >> kStrideShift, std::abs(x - 4) <= 1 ? 0x0000U : 0xAAAAU) << x;
  }
}

TEST(Bricks, StridesUpToABlockAreLongWhereABlockAndItsNeighboursAreThin) {
  VoxelGrid grid;
  grid.size = {49, 9, 9};
  std::vector<std::uint8_t> values(grid.count(), 1);
  values[21 + std::size_t{49} * (3 + 9 * 3)] = 3;  // in block 5 of a row
  grid.values = std::move(values);
  const Bricks bricks = make_bricks(grid);
  std::vector<Appearance> table(4);
  for (std::size_t i = 1; i < 4; ++i) table[i].extinction = static_cast<float>(i);
  const auto first_row = [&](double step_voxels) {
    const LeapMap map = leaps_by_table(bricks, {0, 3}, table, {2.5, 1.5, 0.5}, step_voxels);
    std::string strides;
    for (std::size_t block = 0; block < 12; ++block)
      strides += static_cast<char>('0' + (map.leap[block / 2] >> (kStrideShift + 2 * (block % 2)) & 3U));
    return strides;
  };
  EXPECT_EQ(first_row(1), "222200022222");  // 2 and 4 steps are within a block
  EXPECT_EQ(first_row(2), "221100012222");  // 2 steps alone: for 4, bricks 1 to 3 are near
  EXPECT_EQ(first_row(3), "220000002222");  // no more than a step
}

TEST(Bricks, AValueBetweenTwoSeenOnesIsFoundByTheRangeAlone) {
  Bricks bricks;
  bricks.count = {2, 1, 1};
  bricks.ranges = {{0, 100}, {0, 40}};
  std::vector<Appearance> table(101);
  table[50].extinction = 1;
  const LeapMap map = leaps_by_table(bricks, {0, 100}, table, {}, 1);
  EXPECT_EQ(map.leap[0], 0);
  EXPECT_EQ(map.leap[1], 1);
}

TEST(CoarseGrid, VoxelsAreMeansOfEight) {
  const VoxelGrid fine = random_grid<std::int16_t>({7, 6, 9});
  const auto& from = std::get<std::vector<std::int16_t>>(fine.values);
  VoxelGrid coarse = coarse_grid_of(fine);
  EXPECT_EQ(coarse.size, (std::array<std::uint32_t, 3>{4, 3, 5}));
  fill_coarse_slices(fine, 0, 2, coarse);
  fill_coarse_slices(fine, 2, 5, coarse);
  const auto& to = std::get<std::vector<std::int16_t>>(coarse.values);
  for (std::uint32_t k = 0; k < 5; ++k) {
    for (std::uint32_t j = 0; j < 3; ++j) {
      for (std::uint32_t i = 0; i < 4; ++i) {
        double sum = 0;
        for (unsigned corner = 0; corner < 8; ++corner) {
          const std::uint32_t x = std::min(2 * i + (corner & 1U), 6U);
          const std::uint32_t y = 2 * j + (corner >> 1U & 1U);
          const std::uint32_t z = std::min(2 * k + (corner >> 2U), 8U);
          sum += from[x + 7 * (y + 6 * z)];
        }
        EXPECT_NEAR(to[i + 4 * (j + 3 * k)], sum / 8, 0.51);
      }
    }
  }
}

}  // namespace
}  // namespace cellmirror::volume
