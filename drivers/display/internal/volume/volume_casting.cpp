#include "drivers/display/internal/volume/volume_casting.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace cellmirror::display {

namespace {

constexpr std::size_t kMostSlots = 8;
constexpr std::size_t kMostVolumes = 16;
constexpr int kMostReduction = 4;
constexpr double kCoarsePixels = 1.5;  // a voxel of the coarse copy may cover so many of the pixels that are cast
constexpr double kHasteGains = 1.5;    // of longer steps and an earlier end

bool same_volume(const SceneVolume& a, const SceneVolume& b) {
  return a.grid == b.grid && a.X_WV.matrix() == b.X_WV.matrix() && a.settings == b.settings &&
         a.user_tables == b.user_tables;
}

std::uint64_t hash_of(std::span<const float> depth) {
  std::uint64_t state = 0x9e37'79b9'7f4a'7c15ULL;
  for (std::size_t i = 0; i + 1 < depth.size(); i += 2) {
    std::uint64_t word = 0;
    std::memcpy(&word, depth.data() + i, sizeof(word));
    state = std::rotl(state ^ word, 27) * 0x87c3'7b91'1142'53d5ULL;
  }
  return state;
}

// Every pixel of `over` above those of `picture`.
void put_over(const volume::VolumePicture& over, volume::VolumePicture& picture) {
  for (std::size_t i = 0; i < picture.depth.size(); ++i) {
    const std::uint8_t* const front = over.rgba.data() + 4 * i;
    if (front[3] == 0) continue;
    std::uint8_t* const out = picture.rgba.data() + 4 * i;
    const unsigned through = 255U - front[3];
    for (int c = 0; c < 4; ++c)
      out[c] = static_cast<std::uint8_t>(std::min(255U, front[c] + (out[c] * through + 127U) / 255U));
    picture.depth[i] = std::min(picture.depth[i], over.depth[i]);
  }
}

volume::CastQuality hasty_quality(const SceneVolume& shown, const Frame& frame, int reduction) {
  volume::CastQuality quality = volume::kHastyQuality;
  const double distance = frame.view.distance(shown.X_WV.translation());
  const double pixel_m = reduction * frame.view.metres_per_pixel(distance);
  if (kCoarsePixels * pixel_m >= 2 * shown.grid->spacing_m.maxCoeff()) {
    quality.coarse = volume::CoarseVoxels::always;
    quality.step_voxels = 2;
  }
  return quality;
}

// Those that are drawn, the farthest first.
std::vector<const SceneVolume*> in_order(const Frame& frame) {
  std::vector<const SceneVolume*> order;
  for (const SceneVolume& shown : frame.scene.volumes) {
    if (shown.grid != nullptr && shown.X_WV.matrix().allFinite() && order.size() < kMostVolumes)
      order.push_back(&shown);
  }
  std::ranges::stable_sort(order, std::greater{},
                           [&](const SceneVolume* shown) { return frame.view.distance(shown->X_WV.translation()); });
  return order;
}

}  // namespace

std::array<Eigen::Vector3d, 8> corners_of(const SceneVolume& shown) {
  const Eigen::Vector3d half = shown.grid->half_extent_m();
  std::array<Eigen::Vector3d, 8> corners;
  for (unsigned i = 0; i < 8; ++i) {
    const Eigen::Vector3d sign((i & 1U) != 0 ? 1 : -1, (i & 2U) != 0 ? 1 : -1, (i & 4U) != 0 ? 1 : -1);
    corners[i] = shown.X_WV * half.cwiseProduct(sign);
  }
  return corners;
}

bool VolumeCasting::View::same(const View& other) const {
  return clip_from_world == other.clip_from_world && depth == other.depth &&
         std::ranges::equal(volumes, other.volumes, same_volume);
}

void VolumeCasting::begin(const Scene& scene, Nanoseconds time) {
  time_s_ = seconds(time);
  ++picture_;
  counts_ = {};
  std::vector<std::shared_ptr<const VoxelGrid>> grids;
  for (const SceneVolume& shown : scene.volumes) grids.push_back(shown.grid);
  caster_.keep_only(grids);
  if (scene.volumes.empty()) slots_.clear();
}

VolumeCasting::Slot& VolumeCasting::slot_of(const Frame& frame, std::size_t pane) {
  const PixelRect& pixels = frame.view.pixels();
  for (const auto& slot : slots_) {
    if (slot->pane != pane || slot->camera != frame.camera || slot->width != pixels.width ||
        slot->height != pixels.height)
      continue;
    slot->used = picture_;
    return *slot;
  }
  if (slots_.size() == kMostSlots)
    slots_.erase(std::ranges::min_element(slots_, {}, [](const auto& s) { return s->used; }));
  auto slot = std::make_unique<Slot>();
  slot->pane = pane;
  slot->camera = frame.camera;
  slot->width = pixels.width;
  slot->height = pixels.height;
  slot->used = picture_;
  slots_.push_back(std::move(slot));
  return *slots_.back();
}

int VolumeCasting::reduction_for(double full_s, double time_s) {
  int reduction = 1;
  while (reduction < kMostReduction && full_s / (kHasteGains * reduction * reduction) > time_s) ++reduction;
  return reduction;
}

volume::CastRequest VolumeCasting::request_of(const SceneVolume& shown, const Frame& frame, int reduction) const {
  const PixelRect& pixels = frame.view.pixels();
  volume::CastRequest request;
  request.grid = shown.grid;
  request.settings = shown.settings;
  request.user = shown.user_tables;
  request.width = (pixels.width + reduction - 1) / reduction;
  request.height = (pixels.height + reduction - 1) / reduction;
  // The reduced picture may reach beyond the pane by a part of a pixel.
  Eigen::Vector4d fit(static_cast<double>(pixels.width) / (request.width * reduction),
                      static_cast<double>(pixels.height) / (request.height * reduction), 1, 1);
  Eigen::Matrix4d clip = fit.asDiagonal();
  clip(0, 3) = fit.x() - 1;
  clip(1, 3) = fit.y() - 1;
  request.clip_from_V = clip * frame.view.clip_from_world() * shown.X_WV.matrix();
  return request;
}

void VolumeCasting::cast_into(Slot& slot, const Frame& frame, std::span<const float> depth, int reduction, bool hasty) {
  std::span<const float> used = depth;
  slot.counts = {};
  slot.counts.reduction = static_cast<std::uint64_t>(reduction);
  slot.counts.hasty = hasty;
  bool first = true;
  slot.picture.width = 0;
  for (const SceneVolume* const shown : in_order(frame)) {
    volume::CastRequest request = request_of(*shown, frame, reduction);
    request.quality = hasty ? hasty_quality(*shown, frame, reduction) : volume::kFullQuality;
    if (reduction > 1 && first) {
      depth_.resize(static_cast<std::size_t>(request.width) * static_cast<std::size_t>(request.height));
      for (int y = 0; y < request.height; ++y) {
        for (int x = 0; x < request.width; ++x) {
          const auto from_x = static_cast<std::size_t>(std::min(x * reduction + reduction / 2, slot.width - 1));
          const auto from_y = static_cast<std::size_t>(std::min(y * reduction + reduction / 2, slot.height - 1));
          depth_[static_cast<std::size_t>(y) * static_cast<std::size_t>(request.width) + static_cast<std::size_t>(x)] =
              depth[from_y * static_cast<std::size_t>(slot.width) + from_x];
        }
      }
      used = depth_;
    }
    request.scene_depth = used;
    volume::VolumePicture& into = first ? slot.picture : one_;
    if (!caster_.cast(request, into)) continue;
    if (!first) put_over(one_, slot.picture);
    first = false;
    ++slot.counts.volumes;
    slot.counts.bricks += into.bricks;
    slot.counts.bricks_drawn += into.bricks_drawn;
  }
}

VolumeCasting::Cast VolumeCasting::cast(const Frame& frame, std::size_t pane, std::span<const float> depth) {
  Slot& slot = slot_of(frame, pane);
  View seen{frame.view.clip_from_world(), frame.scene.volumes, hash_of(depth)};
  const bool still = slot.seen.same(seen);
  if (!still || !slot.complete) {
    const bool hasty = !still && time_s_ > 0 && slot.full_s > time_s_;
    const int reduction = hasty ? reduction_for(slot.full_s, time_s_) : 1;
    const Timestamp begun = clock_.now();
    cast_into(slot, frame, depth, reduction, hasty);
    slot.reduction = reduction;
    slot.counts.took = clock_.now() - begun;
    const double full_s = seconds(slot.counts.took) * reduction * reduction * (hasty ? kHasteGains : 1);
    slot.full_s = slot.full_s > 0 ? 0.5 * (slot.full_s + full_s) : full_s;
    slot.complete = !hasty;
    slot.seen = std::move(seen);
  } else {
    slot.counts.took = Nanoseconds{0};
  }
  counts_.volumes += slot.counts.volumes;
  counts_.bricks += slot.counts.bricks;
  counts_.bricks_drawn += slot.counts.bricks_drawn;
  counts_.reduction = std::max(counts_.reduction, slot.counts.reduction);
  counts_.hasty = counts_.hasty || slot.counts.hasty;
  counts_.took += slot.counts.took;
  return {slot.picture.width > 0 ? &slot.picture : nullptr, slot.reduction};
}

void VolumeCasting::cast_each(const Frame& frame, std::span<const float> depth,
                              const std::function<void(const Seen&)>& take) {
  for (const SceneVolume* const shown : in_order(frame)) {
    volume::CastRequest request = request_of(*shown, frame, 1);
    request.scene_depth = depth;
    request.quality.light = false;
    if (caster_.cast(request, one_)) take({shown->object, &one_});
  }
}

}  // namespace cellmirror::display
