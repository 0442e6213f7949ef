// Any grid, settings, camera and depth: no access outside of the voxels, and premultiplied colours.
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "rt_core/base/contract.hpp"
#include "rt_core/volume/caster.hpp"

namespace {

using namespace cellmirror;

// Numbers from the input; zeros after its end.
class Source {
 public:
  Source(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}
  template <class T>
  T next() {
    T value{};
    const std::size_t count = std::min(sizeof(T), left_);
    std::memcpy(&value, data_, count);
    data_ += count;
    left_ -= count;
    return value;
  }
  int below(int bound) { return next<std::uint8_t>() % bound; }
  // Mostly ordinary ones.
  double number(double scale) {
    const int kind = below(16);
    if (kind == 0) return next<double>();
    if (kind == 1) return next<float>();
    return scale * next<std::int16_t>() / 32768.0;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

template <class T>
std::vector<T> values_of(Source& source, std::size_t count) {
  std::vector<T> values(count);
  for (T& value : values) value = source.next<T>();
  return values;
}

std::shared_ptr<VoxelGrid> grid_of(Source& source) {
  auto grid = std::make_shared<VoxelGrid>();
  for (std::uint32_t& n : grid->size) n = 1 + static_cast<std::uint32_t>(source.below(20));
  for (int axis = 0; axis < 3; ++axis) grid->spacing_m[axis] = std::abs(source.number(0.01));
  grid->slope = source.number(4);
  grid->intercept = source.number(2000);
  grid->hounsfield = source.below(2) == 0;
  const int type = source.below(3);
  const std::size_t count = source.below(30) == 0 ? grid->count() / 2 : grid->count();
  if (type == 0) grid->values = values_of<std::uint8_t>(source, count);
  if (type == 1) grid->values = values_of<std::int16_t>(source, count);
  if (type == 2) grid->values = values_of<std::uint16_t>(source, count);
  return grid;
}

VolumeSettings settings_of(Source& source) {
  VolumeSettings settings;
  settings.table = static_cast<VolumeTable>(source.below(kVolumeTables));
  settings.medical = {source.number(1), source.number(1), source.number(1), source.number(1)};
  for (VolumeTableParameters& p : settings.parameters)
    p = {source.number(3), source.number(20), source.number(3), source.number(1.57)};
  for (VolumePlane& plane : settings.planes) {
    plane.side = static_cast<VolumePlaneSide>(source.below(3));
    plane.elevation_rad = source.number(1.6);
    plane.azimuth_rad = source.number(1.6);
    plane.distance_m = source.number(0.1);
  }
  settings.isosurface = source.below(3) == 0;
  settings.iso_value = source.number(2000);
  return settings;
}

Eigen::Matrix4d projection_of(Source& source) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  const double near = 0.01 + std::abs(source.number(0.1));
  const double far = near + 0.1 + std::abs(source.number(2));
  m(0, 0) = 2;
  m(1, 1) = -2;
  m(2, 2) = -(far + near) / (far - near);
  m(2, 3) = -2 * far * near / (far - near);
  m(3, 2) = -1;
  Eigen::Matrix4d placed = Eigen::Matrix4d::Identity();
  for (int axis = 0; axis < 3; ++axis) placed(axis, 3) = source.number(0.3);
  placed(2, 3) -= 0.2;
  if (source.below(4) == 0) {
    for (Eigen::Index i = 0; i < 12; ++i) placed(i % 3, i / 3) += source.number(1);
  }
  return m * placed;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Source source(data, size);
  volume::CastRequest request;
  request.settings = settings_of(source);
  request.clip_from_V = projection_of(source);
  request.width = 1 + source.below(10);
  request.height = 1 + source.below(10);
  request.quality.step_voxels = 0.25 + std::abs(source.number(4));
  if (!(request.quality.step_voxels < 100)) request.quality.step_voxels = 1;
  request.quality.coarse = static_cast<volume::CoarseVoxels>(source.below(3));
  std::vector<float> depth(static_cast<std::size_t>(request.width) * static_cast<std::size_t>(request.height));
  if (source.below(2) == 0) {
    for (float& value : depth) value = static_cast<float>(source.number(1));
    request.scene_depth = depth;
  }
  request.grid = grid_of(source);
  static volume::Caster caster(0);
  caster.keep_only({});
  volume::VolumePicture picture;
  if (!caster.cast(request, picture)) return 0;
  for (std::size_t i = 0; i < picture.depth.size(); ++i) {
    const std::uint8_t* const p = picture.rgba.data() + 4 * i;
    CELLMIRROR_EXPECTS(p[0] <= p[3] && p[1] <= p[3] && p[2] <= p[3]);
  }
  return 0;
}
