// Figures and pictures of a voxel volume, for people.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rt_core/ports/voxel_grid.hpp"

namespace cellmirror::app {

// Values in the unit of the grid.
struct VolumeSummary {
  double least = 0;
  double most = 0;
  double mean = 0;
  double percent_1 = 0;  // of the voxels are less
  double percent_50 = 0;
  double percent_99 = 0;
  // How many voxels have each stored value: 65536 entries, from -32768 on where stored values have signs, else from 0.
  std::vector<std::uint64_t> counts;
  int first_stored = 0;
};
[[nodiscard]] VolumeSummary summarise(const VoxelGrid& grid);

// Shares of the voxels by kind of material; only where values are Hounsfield units.
struct MaterialShares {
  double air = 0;     // below -500
  double fat = 0;     // -500 to -10
  double tissue = 0;  // to 200
  double bone = 0;    // above
};
[[nodiscard]] MaterialShares material_shares(const VoxelGrid& grid, const VolumeSummary& summary);

// Values that are shown from black to white.
struct GreyWindow {
  double middle = 0;
  double width = 1;
};
[[nodiscard]] GreyWindow usual_window(const VoxelGrid& grid, const VolumeSummary& summary);

// The slice through the middle at right angles to `axis` (0: x, 1: y, 2: z), with the next axes: x and y of an image,
// rows from below.
struct MiddleSlice {
  std::size_t across = 0;  // axis of a row
  std::size_t up = 1;
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> grey;
};
[[nodiscard]] MiddleSlice middle_slice(const VoxelGrid& grid, std::size_t axis, const GreyWindow& window);

}  // namespace cellmirror::app
