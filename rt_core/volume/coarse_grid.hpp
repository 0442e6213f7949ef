// A volume at half the resolution: where little is seen, long steps read it, which is an eighth of the memory.
#pragma once

#include <cstdint>

#include "rt_core/ports/voxel_grid.hpp"

namespace cellmirror::volume {

// Each voxel is the mean of 2 x 2 x 2 (at the far borders of odd sizes of those there are, at least 2 voxels each way).
// Values are empty; voxel (i, j, k) has its centre at (2 i + 1/2, ...) of the fine one.
[[nodiscard]] VoxelGrid coarse_grid_of(const VoxelGrid& fine);
// Fills slices [begin, end) of the coarse grid: for several threads.
void fill_coarse_slices(const VoxelGrid& fine, std::uint32_t begin, std::uint32_t end, VoxelGrid& coarse);

}  // namespace cellmirror::volume
