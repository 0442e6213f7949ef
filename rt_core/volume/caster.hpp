// Pictures of volumes by rays, on the processor; knows no graphics system. How a value is seen: transfer.hpp; how a ray
// is sampled: cast_kernel.hpp.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/volume_settings.hpp"
#include "rt_core/ports/voxel_grid.hpp"
#include "rt_core/volume/transfer.hpp"

namespace cellmirror::volume {

// When a copy of the volume at half the resolution is read (an eighth of the memory).
enum class CoarseVoxels : std::uint8_t { never, in_long_steps, always };

struct CastQuality {
  double step_voxels = 1;  // length of a step, in the smallest spacing of the volume; above 0
  double opaque = 0.997;   // a ray ends when it is as opaque
  bool light = true;
  // Where a volume is so thin that 2, 4 or 8 steps together are at most as opaque, they are taken at once; 0: never.
  std::array<double, 3> long_steps = {0.04, 0.03, 0.055};
  CoarseVoxels coarse = CoarseVoxels::in_long_steps;  // with 4 and 8 steps at once
  bool operator==(const CastQuality&) const = default;
};
inline constexpr CastQuality kFullQuality{};
inline constexpr CastQuality kEvenQuality{.long_steps = {0, 0, 0},
                                          .coarse = CoarseVoxels::never};  // every step is sampled
// While something moves. Where the pixels are as large as the voxels of the coarse copy, it suffices.
inline constexpr CastQuality kHastyQuality{.step_voxels = 1.5, .opaque = 0.97, .long_steps = {0.08, 0.06, 0.04}};

struct CastRequest {
  std::shared_ptr<const VoxelGrid> grid;
  VolumeSettings settings;
  UserTables user;
  // Clip space as OpenGL's with y downwards: -1 is the upper edge of the picture. Perspective or parallel.
  Eigen::Matrix4d clip_from_V = Eigen::Matrix4d::Identity();
  int width = 0;  // pixels
  int height = 0;
  std::span<const float> scene_depth;  // window depth (0 to 1) of what hides the volume; width * height, or empty
  CastQuality quality;
};

// Rows from the top, without gaps.
struct VolumePicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  // colours times alpha, 4 a pixel
  std::vector<float> depth;        // window depth where a ray became half opaque; 1 where it did not
  std::uint64_t bricks_drawn = 0;  // with something to be seen
  std::uint64_t bricks = 0;
  std::uint64_t samples = 0;
};

// One thread uses it. Not real time: allocates, starts threads with the first volume.
class Caster {
 public:
  explicit Caster(int threads);  // beside the calling one, in the idle class
  ~Caster();
  Caster(const Caster&) = delete;
  Caster& operator=(const Caster&) = delete;

  // Fails for a grid that disagrees with its size, is larger than 4 GiB, or whose placement is not finite; says why.
  // What is derived from a grid and its table is kept until keep_only().
  [[nodiscard]] Result<void> cast(const CastRequest& request, VolumePicture& picture);
  // The smallest and largest value of a grid.
  [[nodiscard]] Result<ValueRange> range_of(const std::shared_ptr<const VoxelGrid>& grid);
  // Forgets what was derived from other grids.
  void keep_only(std::span<const std::shared_ptr<const VoxelGrid>> grids);

 private:
  struct Prepared;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The instruction set in use, as Highway names it: "AVX3", "AVX2", "SSE4", ...
[[nodiscard]] std::string_view caster_simd_target();

}  // namespace cellmirror::volume
