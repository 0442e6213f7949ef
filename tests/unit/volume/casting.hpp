// What the tests of the caster share: requests, and pixels of pictures.
#pragma once

#include <gtest/gtest.h>

#include "rt_core/volume/caster.hpp"
#include "tests/support/volume/cameras.hpp"
#include "tests/support/volume/phantoms.hpp"

namespace cellmirror::volume {

// LIN_LUT whose extinction is `per_metre` at the largest value of a volume and 0 at its smallest.
inline VolumeSettings linear_settings(const VoxelGrid& grid, double per_metre) {
  VolumeSettings settings;
  settings.table = VolumeTable::linear;
  VolumeTableParameters& parameters = settings.parameters[static_cast<std::size_t>(VolumeTable::linear)];
  parameters.opacity = per_metre * 2 * grid.half_extent_m().maxCoeff() / 40;
  return settings;
}

// The same extinction for every value: USER1_LUT with it.
inline void make_even(CastRequest& request, double per_metre) {
  request.settings = linear_settings(*request.grid, per_metre);
  request.settings.table = VolumeTable::user1;
  std::swap(request.settings.parameters[static_cast<std::size_t>(VolumeTable::user1)],
            request.settings.parameters[static_cast<std::size_t>(VolumeTable::linear)]);
  VolumeUserTable table;
  table.rows = {{-1e6, {1, 1, 1}, 1}, {1e6, {1, 1, 1}, 1}};
  request.user[0] = std::make_shared<const VolumeUserTable>(table);
}

inline CastRequest request_of(const std::shared_ptr<const VoxelGrid>& grid, const phantoms::Camera& camera, int width,
                              int height) {
  CastRequest request;
  request.grid = grid;
  request.width = width;
  request.height = height;
  request.clip_from_V = phantoms::clip_from_world(camera, width, height);
  return request;
}

inline VolumePicture cast(const CastRequest& request, int threads = 1) {
  Caster caster(threads);
  VolumePicture picture;
  const Result<void> done = caster.cast(request, picture);
  EXPECT_TRUE(done) << (done ? "" : done.error().text());
  return picture;
}

inline int alpha_at(const VolumePicture& picture, int x, int y) {
  return picture
      .rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x)) +
            3];
}

// From the eye of `camera` through the middle of a pixel: origin and unit direction.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};
inline Ray ray_of(const CastRequest& request, int x, int y) {
  const Eigen::Matrix4d inverse = request.clip_from_V.inverse();
  const auto point = [&](double z) {
    const Eigen::Vector4d p =
        inverse * Eigen::Vector4d(2 * (x + 0.5) / request.width - 1, 2 * (y + 0.5) / request.height - 1, z, 1);
    return Eigen::Vector3d(p.head<3>() / p.w());
  };
  const Eigen::Vector3d near = point(-1);
  return {near, (point(1) - near).normalized()};
}

}  // namespace cellmirror::volume
