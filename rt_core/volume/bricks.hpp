// The smallest and largest value in each brick of a volume, which bricks the rays can leap over, and where within the
// others steps may be long.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/ports/voxel_grid.hpp"
#include "rt_core/volume/transfer.hpp"

namespace cellmirror::volume {

// Cells of 8 x 8 x 8 pairs of neighbouring voxels: a brick's values are those of 9 x 9 x 9 voxels, so that whatever is
// interpolated within it lies between its smallest and its largest one.
inline constexpr std::uint32_t kBrickCells = 8;
inline constexpr std::uint32_t kBlockCells = 4;  // a brick is 2 x 2 x 2 blocks

struct StoredRange {
  std::int32_t low = 0;  // as stored: before slope and intercept
  std::int32_t high = 0;
  bool operator==(const StoredRange&) const = default;
};

// Of blocks, twice as many as bricks each way: the smallest and largest value in each and its neighbours, as stored
// less `bias`, so that they take 4 bytes a block.
struct BlockRanges {
  std::vector<std::uint16_t> low;
  std::vector<std::uint16_t> high;
  std::int32_t bias = 0;
};

struct Bricks {
  std::array<std::uint32_t, 3> count{};
  std::vector<StoredRange> ranges;  // x + count[0] * (y + count[1] * z)
  StoredRange all;                  // of the whole volume
  BlockRanges blocks;               // may be empty: then steps go by bricks alone
};

// Layers of bricks [begin, end) of `bricks`, whose vectors have their size: for several threads.
void measure_layers(const VoxelGrid& grid, std::uint32_t begin, std::uint32_t end, Bricks& bricks);
[[nodiscard]] Bricks empty_bricks(const VoxelGrid& grid);
void finish(Bricks& bricks);  // `all` and the blocks' neighbours, after the layers
// On the calling thread.
[[nodiscard]] Bricks make_bricks(const VoxelGrid& grid);
[[nodiscard]] ValueRange value_range(const VoxelGrid& grid, const Bricks& bricks);

// What rays do in each brick. Low 4 bits, n: 0 where something in the brick may be seen; else neither it nor any brick
// at most n - 1 bricks away (along each axis) shows anything. Where n = 0, from bit 4 on two bits for each of its
// blocks (x + 2 * (y + 2 * z)): the binary logarithm of how many steps may be taken at once from anywhere in the block,
// since little is seen in what they pass.
struct LeapMap {
  std::array<std::uint32_t, 3> count{};
  std::vector<std::uint32_t> leap;
  std::size_t occupied = 0;  // bricks with n = 0
};
inline constexpr std::uint8_t kLongestStrideLog = 3;
inline constexpr int kStrideShift = 4;  // of the first block's bits

// By a table of extinctions over the stored values from `range.low` to `range.high`, of which a value takes the
// nearest. `stride_limits`: of 2, 4 and 8 steps at once, the extinction (per metre) up to which they are taken; 0:
// never. `step_voxels`: the length of a step, in the smallest spacing of the volume.
[[nodiscard]] LeapMap leaps_by_table(const Bricks& bricks, StoredRange range, std::span<const Appearance> table,
                                     const std::array<double, kLongestStrideLog>& stride_limits, double step_voxels);
// Bricks with a value of at least `threshold` (at most, where `falling`), as stored, are not empty.
[[nodiscard]] LeapMap leaps_by_threshold(const Bricks& bricks, double threshold, bool falling);

}  // namespace cellmirror::volume
