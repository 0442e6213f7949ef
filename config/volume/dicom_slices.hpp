// The pixels of the slices of a series as the values of a VoxelGrid.
#pragma once

#include <vector>

#include "config/volume/dicom_files.hpp"
#include "config/volume/dicom_geometry.hpp"
#include "rt_core/ports/voxel_grid.hpp"

namespace cellmirror {

// Fills size, values, slope and intercept. All slices have the size and format of the first one. Where slope and
// intercept differ from slice to slice, values are converted to common ones, with a warning where that rounds them.
// Slices of a tilted gantry are moved to their places, by interpolation, in a volume that holds all of them. False,
// with errors, where a slice cannot be read. Takes the memory of the values, of a file and of a slice.
[[nodiscard]] bool read_slices(const std::vector<SliceFile>& files, const SeriesGeometry& geometry,
                               VolumeProcess& process, VoxelGrid& grid, Diagnostics& diagnostics);

// The place of the first column and row of a volume that holds all slices, pixels, and how many there are more.
struct ShearedExtent {
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  std::array<std::uint32_t, 2> more{};
};
[[nodiscard]] ShearedExtent sheared_extent(const SeriesGeometry& geometry);

}  // namespace cellmirror
