// How often the values of a voxel volume occur.
#pragma once

#include "rt_core/ports/volume_state.hpp"
#include "rt_core/ports/voxel_grid.hpp"

namespace cellmirror::app {

// From the lowest to the highest value that occurs among at most four million voxels, every n-th of the volume. Takes
// some milliseconds. A volume of one value has one bin that is not empty.
[[nodiscard]] VolumeHistogram histogram_of(const VoxelGrid& grid);

}  // namespace cellmirror::app
