// Readings of the real robots' meshes against Embree's rays: no ray of a dense fan meets anything nearer than what was
// read, and a ray towards the point that was read meets the surface there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "rt_core/ranging/cone.hpp"
#include "tests/unit/ranging_reference/ray_fan.hpp"
#include "tests/unit/ranging_reference/stl.hpp"

namespace cellmirror {
namespace {

using Eigen::Vector3d;

std::filesystem::path robots() {
  const char* shared = std::getenv("CELLMIRROR_SHARED_DATA");
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  const std::filesystem::path root = shared != nullptr   ? std::filesystem::path(shared)
                                     : source != nullptr ? std::filesystem::path(source) / ".." / "shared" / "data"
                                                         : std::filesystem::path();
  return root / "robots";
}

std::vector<std::filesystem::path> meshes() {
  std::vector<std::filesystem::path> out;
  std::error_code none;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(robots(), none)) {
    const std::string path = entry.path().string();
    if (path.ends_with(".stl") && path.find("/collision/") != std::string::npos) out.push_back(entry.path());
  }
  std::ranges::sort(out);
  return out;
}

struct Counts {
  int readings = 0;
  int met = 0;         // of the points that were read, by a ray towards them
  double closest = 1;  // of the fans: least excess over the reading, m
};

void compare(const std::filesystem::path& path, std::mt19937_64& random, Counts& counts) {
  const auto mesh = read_stl(path);
  ASSERT_TRUE(mesh) << path;
  const geometry::Solid solid = geometry::make_mesh_solid(mesh);
  RayFan rays;
  const std::size_t instance = rays.add(mesh);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int i = 0; i < 12; ++i) {
    // Around the mesh, looking roughly at it.
    Pose X_GS = pose_from_xyz_rpy(Vector3d::Zero(), std::numbers::pi * Vector3d(any(random), any(random), any(random)));
    X_GS.translation() = solid.centre + X_GS.linear() * Vector3d(0.6 * solid.radius * any(random),
                                                                 0.6 * solid.radius * any(random), -2.5 * solid.radius);
    const Pose X_SG = X_GS.inverse();
    rays.place(instance, X_SG);
    rays.commit();
    const double half_angle = 0.03 + 0.25 * (any(random) + 1.0);
    constexpr double kRange = 10.0;
    constexpr std::size_t kRays = 4096;
    constexpr double kSingle = 2e-6;  // of rays in single precision, m
    const auto hit = nearest_in_cone(solid, X_SG, ranging::Cone{half_angle}, kRange);
    const auto nearest = rays.nearest(Pose::Identity(), half_angle, kRange, kRays);
    if (!hit) {
      EXPECT_FALSE(nearest) << path << " " << i;
      continue;
    }
    ++counts.readings;
    if (nearest) {
      EXPECT_GE(*nearest, hit->distance - kSingle) << path << " " << i;
      counts.closest = std::min(counts.closest, *nearest - hit->distance);
    }
    // A ray at a vertex or an outline may pass it by a rounding error.
    const auto there = rays.along(Vector3d::Zero(), hit->p_S.normalized(), kRange);
    if (there && std::abs(*there - hit->distance) < 1e-4) ++counts.met;
  }
}

TEST(Robots, are_read_where_rays_meet_them_and_nowhere_nearer) {
  const auto files = meshes();
  if (files.empty()) GTEST_SKIP() << "skipped: the robots of ../shared/data are not on this machine";
  std::mt19937_64 random(1);
  Counts counts;
  for (const auto& file : files) compare(file, random, counts);
  EXPECT_GT(counts.readings, 100);
  EXPECT_GT(counts.met, counts.readings * 3 / 4);
  EXPECT_LT(counts.closest, 1e-4);
}

}  // namespace
}  // namespace cellmirror
