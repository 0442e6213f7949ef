// Rays through a volume, several pixels at a time with the widest vectors that the processor has (Highway, chosen at
// run time). Private to this folder: caster.hpp is its front.
//
// Rays run in index space: voxel (i, j, k) is at (i, j, k), the box of the volume from -1/2 to size - 1/2 each way; in
// the outer half voxel the value of the outermost voxel holds. A ray's parameter t is metres from the near plane. The
// part of a ray within the box, before the depth and within the planes is cut into steps from its beginning; the value
// in the middle of a step (trilinear) stands for the step, and the last, shorter one counts by its length: alpha = 1 -
// exp(-extinction * length).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "rt_core/ports/volume_settings.hpp"

namespace cellmirror::volume {

enum class Stored : std::uint8_t { u8, i16, u16 };

// A quantity that is affine in the pixel's place.
struct AffineRow {
  float at_0 = 0;
  float by_x = 0;
  float by_y = 0;
};

// Voxels in memory: byte offsets from the middle slice lie within +-2^31.
struct KernelVoxels {
  const std::byte* middle_slice = nullptr;
  std::int32_t middle = 0;  // index of that slice
  std::int32_t row_bytes = 0;
  std::int32_t slice_bytes = 0;
  std::int32_t last_offset = 0;    // u8 only: the largest offset at which 4 bytes can be read
  std::array<float, 3> largest{};  // coordinate whose cell is still within: just below the last voxel
};

struct KernelJob {
  KernelVoxels fine;
  KernelVoxels coarse;  // coarse_grid.hpp
  bool has_coarse = false;
  bool all_coarse = false;  // long steps or not
  Stored stored = Stored::i16;
  std::array<float, 3> size{};       // voxels
  std::array<float, 3> per_metre{};  // index units a metre
  // Bricks and the table over the stored values: place = value * scale + offset.
  const std::uint32_t* leap = nullptr;
  std::int32_t leap_row = 0;
  std::int32_t leap_layer = 0;
  const float* alpha = nullptr;           // of a whole step
  const float* depth = nullptr;           // extinction times a whole step
  const std::uint32_t* colour = nullptr;  // red, green, blue, lit: a byte each, red the lowest
  float table_scale = 1;
  float table_offset = 0;
  float table_last = 0;
  float gradient_scale = 0;  // 1 / the gradient (stored units a metre) that is fully lit
  // Rays by the pixel's place (middle of a pixel at + 1/2).
  std::array<AffineRow, 3> origin;     // index space
  std::array<AffineRow, 3> direction;  // any length, index space
  std::array<float, 4> clip_z{};       // of a point of index space: clip.z, clip.w
  std::array<float, 4> clip_w{};
  std::array<std::array<float, 4>, kVolumePlanes> planes{};  // normal . p <= distance, index space
  std::size_t plane_count = 0;
  float step_m = 1e-3F;
  float opaque = 0.997F;  // a ray ends when it is as opaque
  bool light = true;
  bool isosurface = false;
  float threshold = 0;   // stored value
  bool falling = false;  // what is below is solid
  std::uint32_t iso_colour = 0;
  // Pictures, of which a part is cast.
  int width = 0;
  int height = 0;
  const float* scene_depth = nullptr;  // window depth, 0 to 1, a pixel each; null: all 1
  std::uint8_t* rgba = nullptr;        // premultiplied
  float* seen_depth = nullptr;         // window depth where it became half opaque, else 1
};

struct PixelTile {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

struct TileCounts {
  std::uint64_t samples = 0;  // of lanes, also idle ones
  std::uint64_t leaps = 0;
};

// Of a ray; what is beyond is not seen.
inline constexpr float kMostSteps = 8200;

// No heap memory. Any thread; tiles of one job may be cast at a time.
TileCounts cast_tile(const KernelJob& job, const PixelTile& tile);

// The instruction set in use, as Highway names it: "AVX3", "AVX2", "SSE4", ...
[[nodiscard]] std::string_view simd_target();

}  // namespace cellmirror::volume
