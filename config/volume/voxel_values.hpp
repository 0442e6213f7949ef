// Voxels of any type as the values of a VoxelGrid.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "config/volume/voxel_stream.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/voxel_grid.hpp"

namespace cellmirror {

enum class VoxelType : std::uint8_t { s8, u8, s16, u16, s32, u32, s64, u64, f32, f64 };

[[nodiscard]] std::size_t bytes_of(VoxelType type);
// "16 bit signed"
[[nodiscard]] std::string text_of(VoxelType type);

struct VoxelFormat {
  std::array<std::uint32_t, 3> size{};
  VoxelType type = VoxelType::s16;
  bool big_endian = false;
  bool last_slice_first = false;  // the file has them in reverse
};

struct VoxelValues {
  VoxelGrid::Values values;
  // value in the file = slope * stored + intercept
  double slope = 1;
  double intercept = 0;
  bool rounded = false;  // to 16 bits
};

// 8 and 16 bits stay as they are; wider types become 16 bits: without loss where their values are integers in a range
// of 65536, else in equal steps between the least and the largest value. Those are read twice. Takes the memory of the
// values and of one slice. Refused: what check_voxels() refuses, too few data, NaN and infinity (with the voxel).
[[nodiscard]] Result<VoxelValues> read_voxels(const VoxelSource& source, const VoxelFormat& format);

}  // namespace cellmirror
