// A regular grid of values: computed tomography and the like. Plain data; what computes with it is in rt_core/volume.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace cellmirror {

// Frame V: origin in the middle of the grid, x along the columns of a slice (index i), y along its rows (index j), z
// along the slices (index k), right-handed. The centre of voxel (0, 0, 0) is at -(size - 1) / 2 * spacing.
// Immutable once it is shared: any thread reads it.
struct VoxelGrid {
  using Values = std::variant<std::vector<std::uint8_t>, std::vector<std::int16_t>, std::vector<std::uint16_t>>;

  std::string name;                     // of the component
  std::array<std::uint32_t, 3> size{};  // voxels along x, y, z; at least 2
  Eigen::Vector3d spacing_m = Eigen::Vector3d::Constant(1e-3);
  Values values;     // i + size[0] * (j + size[1] * k)
  double slope = 1;  // value = slope * stored + intercept: Hounsfield units where `hounsfield`
  double intercept = 0;
  bool hounsfield = false;  // else tables go by the range of the values

  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(size[0]) * size[1] * size[2]; }
  [[nodiscard]] Eigen::Vector3d half_extent_m() const {
    return 0.5 * Eigen::Vector3d(size[0], size[1], size[2]).cwiseProduct(spacing_m);
  }
};

}  // namespace cellmirror
