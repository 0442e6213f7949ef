#include "rt_core/volume/caster.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <string>

#include "rt_core/volume/bricks.hpp"
#include "rt_core/volume/cast_kernel.hpp"
#include "rt_core/volume/coarse_grid.hpp"
#include "rt_core/volume/idle_workers.hpp"
#include "rt_core/volume/planes.hpp"

namespace cellmirror::volume {

namespace {

constexpr int kTileEdge = 32;  // pixels
constexpr std::uint32_t kSlicesAtOnce = 8;
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 32U;
constexpr double kFullyLitHu = 60;         // a voxel: such a gradient is a surface
constexpr double kFullyLitPart = 0.04;     // of the range, where the unit is another one
constexpr double kStepsOfDiagonal = 8192;  // steps are longer in volumes with one very short spacing
constexpr double kFarthest = 1e6;          // m
constexpr float kLeastIsoBrightness = 0.85F;

std::uint64_t bytes_a_voxel(const VoxelGrid& grid) { return grid.values.index() == 0 ? 1 : 2; }

Result<void> check(const VoxelGrid& grid) {
  const auto refuse = [&](std::string why) {
    return fail("volume " + grid.name + " is not drawn: " + std::move(why), "see cellmirror volume info");
  };
  const bool sized = std::ranges::all_of(grid.size, [](std::uint32_t n) { return n >= 2 && n <= 65536; });
  if (!sized) return refuse("it needs 2 to 65536 voxels each way");
  if (static_cast<double>(grid.size[0]) * grid.size[1] * grid.size[2] * static_cast<double>(bytes_a_voxel(grid)) >
      static_cast<double>(kMostBytes))
    return refuse("it is larger than 4 GiB");
  const std::size_t values = std::visit([](const auto& all) { return all.size(); }, grid.values);
  if (values != grid.count()) return refuse("it has " + std::to_string(values) + " values");
  if (!grid.spacing_m.allFinite() || !(grid.spacing_m.minCoeff() > 1e-9) || grid.spacing_m.maxCoeff() > kFarthest)
    return refuse("its spacing is not above 0");
  if (!std::isfinite(grid.slope) || !std::isfinite(grid.intercept) || grid.slope == 0)
    return refuse("its values cannot be rescaled");
  return {};
}

std::uint32_t packed(const Appearance& look) {
  const auto byte = [](float part) {
    return static_cast<std::uint32_t>(std::lround(std::clamp(part, 0.0F, 1.0F) * 255));
  };
  return byte(look.rgb[0]) | byte(look.rgb[1]) << 8U | byte(look.rgb[2]) << 16U | byte(look.lit) << 24U;
}

// Of a volume, index space from V.
Eigen::Matrix4d volume_to_index(const VoxelGrid& grid) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    m(axis, axis) = 1 / grid.spacing_m[axis];
    m(axis, 3) = 0.5 * (grid.size[static_cast<std::size_t>(axis)] - 1.0);
  }
  return m;
}

KernelVoxels voxels_of(const VoxelGrid& grid) {
  KernelVoxels voxels;
  const std::uint64_t bytes = bytes_a_voxel(grid);
  const std::uint64_t slice = grid.size[1] * (grid.size[0] * bytes);
  voxels.row_bytes = static_cast<std::int32_t>(grid.size[0] * bytes);
  voxels.slice_bytes = static_cast<std::int32_t>(slice);
  voxels.middle = static_cast<std::int32_t>(grid.size[2] / 2);
  const auto* const first =
      std::visit([](const auto& all) { return reinterpret_cast<const std::byte*>(all.data()); }, grid.values);
  const std::uint64_t before = slice * static_cast<std::uint64_t>(voxels.middle);
  voxels.middle_slice = first + before;
  voxels.last_offset = static_cast<std::int32_t>(static_cast<std::int64_t>(slice * grid.size[2]) - 4 -
                                                 static_cast<std::int64_t>(before));
  for (std::size_t axis = 0; axis < 3; ++axis)
    voxels.largest[axis] = std::nextafter(static_cast<float>(grid.size[axis] - 1), 0.0F);
  return voxels;
}

void set_voxels(const VoxelGrid& grid, const VoxelGrid& coarse, KernelJob& job) {
  job.stored = static_cast<Stored>(grid.values.index());
  job.fine = voxels_of(grid);
  job.coarse = voxels_of(coarse);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    job.size[axis] = static_cast<float>(grid.size[axis]);
    job.per_metre[axis] = static_cast<float>(1 / grid.spacing_m[static_cast<Eigen::Index>(axis)]);
  }
}

// False where the projection cannot be turned back.
bool set_rays(const CastRequest& request, const Eigen::Matrix4d& clip_from_index, KernelJob& job) {
  const Eigen::Matrix4d index_from_clip = clip_from_index.inverse();
  if (!index_from_clip.allFinite() || !clip_from_index.allFinite()) return false;
  const auto point = [&](double x, double y, double z) {
    const Eigen::Vector4d p =
        index_from_clip * Eigen::Vector4d(2 * x / request.width - 1, 2 * y / request.height - 1, z, 1);
    return Eigen::Vector3d(p.head<3>() / p.w());
  };
  const Eigen::Vector3d near_0 = point(0, 0, -1);
  const Eigen::Vector3d near_x = point(request.width, 0, -1) - near_0;
  const Eigen::Vector3d near_y = point(0, request.height, -1) - near_0;
  const Eigen::Vector3d far_0 = point(0, 0, 1) - near_0;
  const Eigen::Vector3d far_x = point(request.width, 0, 1) - point(request.width, 0, -1) - far_0;
  const Eigen::Vector3d far_y = point(0, request.height, 1) - point(0, request.height, -1) - far_0;
  const double length = (far_0 + 0.5 * far_x + 0.5 * far_y).norm();
  if (!near_0.allFinite() || !far_x.allFinite() || !far_y.allFinite() || !(length > 0)) return false;
  const auto row = [&](double at_0, double by_x, double by_y, double scale) {
    return AffineRow{static_cast<float>(at_0 * scale), static_cast<float>(by_x * scale / request.width),
                     static_cast<float>(by_y * scale / request.height)};
  };
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    job.origin[i] = row(near_0[axis], near_x[axis], near_y[axis], 1);
    job.direction[i] = row(far_0[axis], far_x[axis], far_y[axis], 1 / length);
  }
  for (Eigen::Index k = 0; k < 4; ++k) {
    job.clip_z[static_cast<std::size_t>(k)] = static_cast<float>(clip_from_index(2, k));
    job.clip_w[static_cast<std::size_t>(k)] = static_cast<float>(clip_from_index(3, k));
  }
  return true;
}

void set_planes(const CastRequest& request, const Eigen::Matrix4d& index_from_V, KernelJob& job) {
  const Eigen::Matrix4d index_to_volume = index_from_V.inverse();
  for (const HalfSpace& kept : clipping(request.settings)) {
    const Eigen::Vector4d row(kept.normal.x(), kept.normal.y(), kept.normal.z(), -kept.distance);
    const Eigen::RowVector4d plane = row.transpose() * index_to_volume;  // <= 0 is kept
    job.planes[job.plane_count++] = {static_cast<float>(plane[0]), static_cast<float>(plane[1]),
                                     static_cast<float>(plane[2]), static_cast<float>(-plane[3])};
  }
}

// The pixels that the volume may cover; all of them where a corner is behind the eye.
PixelTile covered(const CastRequest& request) {
  const PixelTile all{0, 0, request.width, request.height};
  const Eigen::Vector3d half = request.grid->half_extent_m();
  Eigen::Array2d low = Eigen::Array2d::Constant(1e9);
  Eigen::Array2d high = -low;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Eigen::Vector4d p(((corner & 1U) != 0 ? 1 : -1) * half.x(), ((corner & 2U) != 0 ? 1 : -1) * half.y(),
                            ((corner & 4U) != 0 ? 1 : -1) * half.z(), 1);
    const Eigen::Vector4d clip = request.clip_from_V * p;
    if (!(clip.w() > 1e-9)) return all;
    const Eigen::Array2d pixel =
        (clip.head<2>().array() / clip.w() + 1) / 2 * Eigen::Array2d(request.width, request.height);
    low = low.min(pixel);
    high = high.max(pixel);
  }
  const auto bound = [](double value, int most) { return static_cast<int>(std::clamp(value, 0.0, 1.0 * most)); };
  const int x = bound(low.x() - 1, request.width);
  const int y = bound(low.y() - 1, request.height);
  return {x, y, bound(high.x() + 2, request.width) - x, bound(high.y() + 2, request.height) - y};
}

bool same_look(const VolumeSettings& a, const VolumeSettings& b) {
  return a.table == b.table && a.medical == b.medical && a.parameters == b.parameters && a.isosurface == b.isosurface &&
         a.iso_value == b.iso_value;
}

}  // namespace

struct Caster::Prepared {
  std::shared_ptr<const VoxelGrid> grid;
  VoxelGrid coarse;
  Bricks bricks;
  ValueRange range;
  // Of the settings that were cast last.
  std::optional<VolumeSettings> settings;
  UserTables user;
  TransferFunction transfer;  // entries over the stored values
  LeapMap leaps;
  std::vector<std::uint32_t> colours;
  std::uint32_t iso_colour = 0;
  std::optional<CastQuality> quality;  // that the following are of
  double step_m = 0;
  std::vector<float> alpha;
  std::vector<float> depth;

  void look_as(const CastRequest& request);
  void cast_as(const CastQuality& wanted);
};

struct Caster::Impl {
  explicit Impl(int wanted) : threads(wanted) {}
  Result<Prepared*> prepare(const std::shared_ptr<const VoxelGrid>& grid);
  [[nodiscard]] static KernelJob job_of(const CastRequest& request, const Prepared& prepared);

  int threads;
  std::unique_ptr<IdleWorkers> workers;  // with the first volume
  std::vector<std::unique_ptr<Prepared>> prepared;
};

void Caster::Prepared::look_as(const CastRequest& request) {
  if (settings && same_look(*settings, request.settings) && user == request.user) return;
  settings = request.settings;
  user = request.user;
  transfer = make_transfer({.settings = request.settings,
                            .range = range,
                            .hounsfield = grid->hounsfield,
                            .longest_edge_m = 2 * grid->half_extent_m().maxCoeff(),
                            .user = request.user});
  Appearance surface = transfer.at(request.settings.iso_value);
  const float brightest = *std::ranges::max_element(surface.rgb);
  for (float& part : surface.rgb) part = brightest > 0.05F ? part * kLeastIsoBrightness / brightest : 0.7F;
  surface.lit = 1;
  iso_colour = packed(surface);
  if (grid->slope < 0) std::ranges::reverse(transfer.entries);
  colours.resize(transfer.entries.size());
  std::ranges::transform(transfer.entries, colours.begin(), packed);
  const double threshold = (request.settings.iso_value - grid->intercept) / grid->slope;
  if (request.settings.isosurface) leaps = leaps_by_threshold(bricks, threshold, grid->slope < 0);
  quality.reset();
}

void Caster::Prepared::cast_as(const CastQuality& wanted) {
  if (quality == wanted) return;
  quality = wanted;
  const double diagonal = 2 * grid->half_extent_m().norm();
  step_m = std::max(wanted.step_voxels * grid->spacing_m.minCoeff(), diagonal / kStepsOfDiagonal);
  alpha.resize(transfer.entries.size());
  depth.resize(transfer.entries.size());
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    const double of_step = static_cast<double>(transfer.entries[i].extinction) * step_m;
    depth[i] = static_cast<float>(of_step);
    alpha[i] = static_cast<float>(-std::expm1(-of_step));
  }
  if (settings->isosurface) return;
  std::array<double, kLongestStrideLog> limits{};
  for (std::size_t i = 0; i < limits.size(); ++i)
    limits[i] = -std::log1p(-std::clamp(wanted.long_steps[i], 0.0, 0.5)) / (std::exp2(i + 1) * step_m);
  leaps = leaps_by_table(bricks, bricks.all, transfer.entries, limits, step_m / grid->spacing_m.minCoeff());
}

Result<Caster::Prepared*> Caster::Impl::prepare(const std::shared_ptr<const VoxelGrid>& grid) {
  if (grid == nullptr) return fail("a volume without data is not drawn");
  for (const auto& known : prepared) {
    if (known->grid == grid) return known.get();
  }
  if (Result<void> checked = check(*grid); !checked) return std::unexpected(checked.error());
  if (workers == nullptr) workers = std::make_unique<IdleWorkers>(threads);
  auto made = std::make_unique<Prepared>();
  made->grid = grid;
  made->bricks = empty_bricks(*grid);
  workers->run(made->bricks.count[2], [&](std::size_t layer) {
    const auto begin = static_cast<std::uint32_t>(layer);
    measure_layers(*grid, begin, begin + 1, made->bricks);
  });
  finish(made->bricks);
  made->coarse = coarse_grid_of(*grid);
  workers->run((made->coarse.size[2] + kSlicesAtOnce - 1) / kSlicesAtOnce, [&](std::size_t part) {
    const auto begin = static_cast<std::uint32_t>(part) * kSlicesAtOnce;
    fill_coarse_slices(*grid, begin, std::min(begin + kSlicesAtOnce, made->coarse.size[2]), made->coarse);
  });
  made->range = value_range(*grid, made->bricks);
  prepared.push_back(std::move(made));
  return prepared.back().get();
}

KernelJob Caster::Impl::job_of(const CastRequest& request, const Prepared& prepared) {
  const VoxelGrid& grid = *request.grid;
  KernelJob job;
  set_voxels(grid, prepared.coarse, job);
  job.has_coarse = request.quality.coarse != CoarseVoxels::never;
  job.all_coarse = request.quality.coarse == CoarseVoxels::always;
  job.leap = prepared.leaps.leap.data();
  job.leap_row = static_cast<std::int32_t>(prepared.leaps.count[0]);
  job.leap_layer = static_cast<std::int32_t>(prepared.leaps.count[0] * prepared.leaps.count[1]);
  job.alpha = prepared.alpha.data();
  job.depth = prepared.depth.data();
  job.colour = prepared.colours.data();
  const StoredRange& all = prepared.bricks.all;
  const double last = static_cast<double>(prepared.colours.size() - 1);
  const double scale = last / std::max(1.0, static_cast<double>(all.high) - all.low);
  job.table_scale = static_cast<float>(scale);
  job.table_offset = static_cast<float>(0.5 - scale * all.low);  // the nearest entry
  job.table_last = static_cast<float>(last + 0.49);
  const double span = static_cast<double>(all.high) - all.low;
  const double fully_lit = grid.hounsfield ? kFullyLitHu / std::abs(grid.slope) : kFullyLitPart * std::max(1.0, span);
  job.gradient_scale = static_cast<float>(grid.spacing_m.minCoeff() / fully_lit);
  job.step_m = static_cast<float>(prepared.step_m);
  job.opaque = static_cast<float>(request.quality.opaque);
  job.light = request.quality.light;
  job.isosurface = request.settings.isosurface;
  job.threshold = static_cast<float>((request.settings.iso_value - grid.intercept) / grid.slope);
  job.falling = grid.slope < 0;
  job.iso_colour = prepared.iso_colour;
  job.width = request.width;
  job.height = request.height;
  job.scene_depth = request.scene_depth.empty() ? nullptr : request.scene_depth.data();
  return job;
}

Caster::Caster(int threads) : impl_(std::make_unique<Impl>(threads)) {}
Caster::~Caster() = default;

Result<void> Caster::cast(const CastRequest& request, VolumePicture& picture) {
  const auto pixels =
      static_cast<std::size_t>(std::max(request.width, 0)) * static_cast<std::size_t>(std::max(request.height, 0));
  if (pixels == 0 || pixels > std::size_t{1} << 26U) return fail("a picture of a volume without pixels");
  if (!request.scene_depth.empty() && request.scene_depth.size() != pixels)
    return fail("the depth of the scene is not of the picture's size");
  if (!(request.quality.step_voxels > 0.01)) return fail("the steps of rays are too short");
  const Result<Prepared*> known = impl_->prepare(request.grid);
  if (!known) return std::unexpected(known.error());
  Prepared& prepared = **known;
  prepared.look_as(request);
  prepared.cast_as(request.quality);
  KernelJob job = Impl::job_of(request, prepared);
  const Eigen::Matrix4d from_V = volume_to_index(*request.grid);
  if (!set_rays(request, request.clip_from_V * from_V.inverse(), job))
    return fail("volume " + request.grid->name + " is not drawn: its placement is not finite");
  set_planes(request, from_V, job);

  picture.width = request.width;
  picture.height = request.height;
  picture.rgba.assign(4 * pixels, 0);
  picture.depth.assign(pixels, 1.0F);
  picture.bricks = prepared.bricks.ranges.size();
  picture.bricks_drawn = prepared.leaps.occupied;
  job.rgba = picture.rgba.data();
  job.seen_depth = picture.depth.data();
  const PixelTile part = covered(request);
  picture.samples = 0;
  if (part.width <= 0 || part.height <= 0 || prepared.leaps.occupied == 0) return {};
  const int across = (part.width + kTileEdge - 1) / kTileEdge;
  const int down = (part.height + kTileEdge - 1) / kTileEdge;
  std::atomic<std::uint64_t> samples{0};
  impl_->workers->run(static_cast<std::size_t>(across) * static_cast<std::size_t>(down), [&](std::size_t i) {
    const int x = part.x + static_cast<int>(i) % across * kTileEdge;
    const int y = part.y + static_cast<int>(i) / across * kTileEdge;
    const PixelTile tile{x, y, std::min(kTileEdge, part.x + part.width - x),
                         std::min(kTileEdge, part.y + part.height - y)};
    samples.fetch_add(cast_tile(job, tile).samples, std::memory_order_relaxed);
  });
  picture.samples = samples.load();
  return {};
}

Result<ValueRange> Caster::range_of(const std::shared_ptr<const VoxelGrid>& grid) {
  const Result<Prepared*> known = impl_->prepare(grid);
  if (!known) return std::unexpected(known.error());
  return (*known)->range;
}

void Caster::keep_only(std::span<const std::shared_ptr<const VoxelGrid>> grids) {
  std::erase_if(impl_->prepared,
                [&](const auto& known) { return std::ranges::find(grids, known->grid) == grids.end(); });
}

std::string_view caster_simd_target() { return simd_target(); }

}  // namespace cellmirror::volume
