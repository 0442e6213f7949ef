// The smallest and largest value in each brick of a volume, and which bricks the rays can leap over.
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

struct StoredRange {
  std::int32_t low = 0;  // as stored: before slope and intercept
  std::int32_t high = 0;
  bool operator==(const StoredRange&) const = default;
};

struct Bricks {
  std::array<std::uint32_t, 3> count{};
  std::vector<StoredRange> ranges;  // x + count[0] * (y + count[1] * z)
  StoredRange all;                  // of the whole volume
};

// Layers of bricks [begin, end) of `bricks`, whose count is set and ranges have their size: for several threads.
void measure_layers(const VoxelGrid& grid, std::uint32_t begin, std::uint32_t end, Bricks& bricks);
[[nodiscard]] Bricks empty_bricks(const VoxelGrid& grid);
void finish(Bricks& bricks);  // `all`, after the layers
// On the calling thread.
[[nodiscard]] Bricks make_bricks(const VoxelGrid& grid);
[[nodiscard]] ValueRange value_range(const VoxelGrid& grid, const Bricks& bricks);

// What rays do in each brick. Low 4 bits, n: 0 where something in the brick may be seen; else neither it nor any brick
// at most n - 1 bricks away (along each axis) shows anything. High 4 bits, where n = 0: the binary logarithm of how
// many steps may be taken at once there, from anywhere in the brick, since little is seen in it and its neighbours.
struct LeapMap {
  std::array<std::uint32_t, 3> count{};
  std::vector<std::uint8_t> leap;  // with 3 bytes behind: it is read 4 bytes at a time
  std::size_t occupied = 0;        // bricks with n = 0
};
inline constexpr std::uint8_t kLongestStrideLog = 3;

// By a table of extinctions over the stored values from `range.low` to `range.high`, of which a value takes the
// nearest. `stride_limits`: of 2, 4 and 8 steps at once, the extinction (per metre) up to which they are taken; 0:
// never.
[[nodiscard]] LeapMap leaps_by_table(const Bricks& bricks, StoredRange range, std::span<const Appearance> table,
                                     const std::array<double, kLongestStrideLog>& stride_limits);
// Bricks with a value of at least `threshold` (at most, where `falling`), as stored, are not empty.
[[nodiscard]] LeapMap leaps_by_threshold(const Bricks& bricks, double threshold, bool falling);

}  // namespace cellmirror::volume
