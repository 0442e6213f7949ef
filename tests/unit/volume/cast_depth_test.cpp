// What hides a volume, what a volume hides, isosurfaces, and what is refused.
#include <limits>

#include "tests/unit/volume/casting.hpp"

namespace cellmirror::volume {
namespace {

constexpr int kPixels = 80;
constexpr double kBall = 0.05;

std::shared_ptr<VoxelGrid> ball_of(double slope = 1) {
  auto grid = phantoms::grid_of<std::int16_t>(
      {64, 64, 64}, Eigen::Vector3d::Constant(0.002),
      [&](const Eigen::Vector3d& p) { return slope * 1000 * phantoms::part_inside(kBall - p.norm(), 0.02); });
  grid->slope = slope;
  return grid;
}

// Window depth of a point.
double depth_of(const CastRequest& request, const Eigen::Vector3d& p) {
  const Eigen::Vector4d clip = request.clip_from_V * p.homogeneous();
  return 0.5 * clip.z() / clip.w() + 0.5;
}

// Where a ray enters the ball; NaN: nowhere.
double entry_of(const Ray& ray) {
  const double middle = -ray.origin.dot(ray.direction);
  const double half = kBall * kBall - ray.origin.cross(ray.direction).squaredNorm();
  return half > 0 ? middle - std::sqrt(half) : std::numeric_limits<double>::quiet_NaN();
}

class Depth : public testing::TestWithParam<double> {  // the height of a parallel view; 0: perspective
 protected:
  CastRequest request_for(const std::shared_ptr<const VoxelGrid>& grid) const {
    return request_of(grid, {.from = Eigen::Vector3d(0.05, -0.3, 0.1), .height_m = GetParam()}, kPixels, kPixels);
  }
};

TEST_P(Depth, OfTheSceneEndsARay) {
  const auto grid = phantoms::grid_of<std::uint8_t>({50, 50, 50}, Eigen::Vector3d::Constant(0.002),
                                                    [](const Eigen::Vector3d&) { return 100.0; });
  CastRequest request = request_for(grid);
  make_even(request, 10);
  // A wall at y = 0.013.
  std::vector<float> wall;
  std::vector<double> expected;
  for (int y = 0; y < kPixels; ++y) {
    for (int x = 0; x < kPixels; ++x) {
      const Ray ray = ray_of(request, x, y);
      const double t = (0.013 - ray.origin.y()) / ray.direction.y();
      wall.push_back(static_cast<float>(depth_of(request, ray.origin + t * ray.direction)));
      double begin = 0;
      double end = t;
      for (int axis = 0; axis < 3; ++axis) {
        const double a = (-0.05 - ray.origin[axis]) / ray.direction[axis];
        const double b = (0.05 - ray.origin[axis]) / ray.direction[axis];
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
      }
      expected.push_back(255 * (1 - std::exp(-10 * std::max(0.0, end - begin))));
    }
  }
  request.scene_depth = wall;
  const VolumePicture sut = cast(request);
  for (std::size_t i = 0; i < wall.size(); ++i) EXPECT_NEAR(sut.rgba[4 * i + 3], expected[i], 1.0) << i;
}

TEST_P(Depth, IsToldWhereARayBecameHalfOpaque) {
  const auto grid = ball_of();
  CastRequest request = request_for(grid);
  request.settings.isosurface = true;
  request.settings.iso_value = 500;
  const VolumePicture surface = cast(request);
  request.settings = linear_settings(*grid, 5);
  const VolumePicture thin = cast(request);
  std::size_t hits = 0;
  for (int y = 0; y < kPixels; ++y) {
    for (int x = 0; x < kPixels; ++x) {
      const Ray ray = ray_of(request, x, y);
      const double t = entry_of(ray);
      const auto i = static_cast<std::size_t>(y * kPixels + x);
      EXPECT_EQ(thin.depth[i], 1);  // 5 per metre: at most 0.4
      if (std::isnan(t)) {
        EXPECT_TRUE(surface.depth[i] == 1 || ray.origin.cross(ray.direction).norm() < kBall + 0.0005);
        continue;
      }
      if (ray.origin.cross(ray.direction).norm() > 0.97 * kBall) continue;
      ++hits;
      EXPECT_EQ(surface.rgba[4 * i + 3], 255);
      const double before = depth_of(request, ray.origin + (t - 0.0006) * ray.direction);
      const double behind = depth_of(request, ray.origin + (t + 0.0006) * ray.direction);
      EXPECT_GT(surface.depth[i], before);
      EXPECT_LT(surface.depth[i], behind);
    }
  }
  EXPECT_GT(hits, 500U);
}

INSTANTIATE_TEST_SUITE_P(Views, Depth, testing::Values(0.0, 0.12));

TEST(Isosurface, IsBrightWhereItFacesTheEyeAndDarkAtItsRim) {
  const auto grid = ball_of();
  CastRequest request = request_of(grid, {.from = Eigen::Vector3d(0, -0.3, 0), .height_m = 0.12}, kPixels, kPixels);
  request.settings.isosurface = true;
  request.settings.iso_value = 500;
  const VolumePicture sut = cast(request);
  const auto brightness = [&](int x) { return sut.rgba[4 * static_cast<std::size_t>(kPixels / 2 * kPixels + x)]; };
  int last = 255;
  for (int x = kPixels / 2; x < kPixels / 2 + 30; x += 5) {
    const double sine = (x + 0.5 - kPixels / 2.0) * 0.12 / kPixels / kBall;
    const double cosine = std::sqrt(1 - sine * sine);
    EXPECT_NEAR(brightness(x) / 255.0, 0.85 * (0.3 + 0.7 * cosine) + 0.18 * std::pow(cosine, 32), 0.06) << x;
    EXPECT_LE(brightness(x), last + 2);
    last = brightness(x);
  }
}

TEST(Isosurface, OfANegativeSlopeIsTheSame) {
  CastRequest request = request_of(ball_of(), {.from = Eigen::Vector3d(0.05, -0.3, 0.1)}, kPixels, kPixels);
  request.settings.isosurface = true;
  request.settings.iso_value = 500;
  const VolumePicture rising = cast(request);
  request.grid = ball_of(-1);
  const VolumePicture falling = cast(request);
  for (std::size_t i = 0; i < rising.rgba.size(); ++i) EXPECT_NEAR(rising.rgba[i], falling.rgba[i], 2);
}

TEST(Isosurface, APlaneThroughItsInsideIsSolid) {
  CastRequest request =
      request_of(ball_of(), {.from = Eigen::Vector3d(0, -0.3, 0), .height_m = 0.12}, kPixels, kPixels);
  request.settings.isosurface = true;
  request.settings.iso_value = 500;
  request.settings.planes[0] = {.side = VolumePlaneSide::before, .azimuth_rad = std::acos(0.0), .distance_m = 0.01};
  const VolumePicture sut = cast(request);
  const auto middle = static_cast<std::size_t>(kPixels / 2 * kPixels + kPixels / 2);
  EXPECT_EQ(sut.rgba[4 * middle + 3], 255);
  EXPECT_NEAR(sut.depth[middle], depth_of(request, {0, 0.01, 0}), 2e-5);
}

TEST(Caster, RefusesWhatCannotBeDrawn) {
  Caster caster(0);
  VolumePicture picture;
  const auto refusal = [&](const std::function<void(CastRequest&, VoxelGrid&)>& change) {
    auto grid = std::make_shared<VoxelGrid>(*ball_of());
    CastRequest request = request_of(grid, {}, 32, 32);
    change(request, *grid);
    const Result<void> done = caster.cast(request, picture);
    return done ? std::string() : done.error().text();
  };
  EXPECT_EQ(refusal([](CastRequest&, VoxelGrid&) {}), "");
  EXPECT_NE(refusal([](CastRequest& r, VoxelGrid&) { r.grid = nullptr; }), "");
  EXPECT_NE(refusal([](CastRequest&, VoxelGrid& g) { g.size[2] = 65; }), "");
  EXPECT_NE(refusal([](CastRequest&, VoxelGrid& g) { g.size = {1, 64, 64}; }), "");
  EXPECT_NE(refusal([](CastRequest&, VoxelGrid& g) { g.size = {60000, 60000, 60000}; }), "");
  EXPECT_NE(refusal([](CastRequest&, VoxelGrid& g) { g.spacing_m[1] = 0; }), "");
  EXPECT_NE(refusal([](CastRequest&, VoxelGrid& g) { g.slope = std::nan(""); }), "");
  EXPECT_NE(refusal([](CastRequest& r, VoxelGrid&) { r.clip_from_V.setZero(); }), "");
  EXPECT_NE(refusal([](CastRequest& r, VoxelGrid&) { r.clip_from_V(0, 0) = std::nan(""); }), "");
  EXPECT_NE(refusal([](CastRequest& r, VoxelGrid&) { r.width = 0; }), "");
  const std::vector<float> short_depth(5, 1.0F);
  EXPECT_NE(refusal([&](CastRequest& r, VoxelGrid&) { r.scene_depth = short_depth; }), "");
}

TEST(Caster, AVeryShortSpacingTakesNoLongTime) {
  const auto grid = phantoms::grid_of<std::uint8_t>({8, 8, 8}, Eigen::Vector3d(2e-9, 0.01, 0.02),
                                                    [](const Eigen::Vector3d& p) { return p.y() > 0 ? 9.0 : 0.0; });
  CastRequest request = request_of(grid, {.from = Eigen::Vector3d(0, -0.3, 0), .height_m = 1e-8}, 32, 32);
  request.settings = linear_settings(*grid, 1);
  EXPECT_LT(cast(request).samples, 32U * 32 * 10'000);
}

TEST(Caster, VolumesBehindTheEyeAreNotSeenAndOnesAroundItAre) {
  const auto grid = ball_of();
  CastRequest request = request_of(grid, {.from = Eigen::Vector3d(0, 0.3, 0), .to = Eigen::Vector3d(0, 1, 0)}, 32, 32);
  request.settings = linear_settings(*grid, 30);
  const VolumePicture behind = cast(request);
  EXPECT_TRUE(std::ranges::all_of(behind.rgba, [](std::uint8_t v) { return v == 0; }));
  request =
      request_of(grid, {.from = Eigen::Vector3d(0, 0.001, 0), .to = Eigen::Vector3d(0, 1, 0), .near_m = 0.001}, 32, 32);
  request.settings = linear_settings(*grid, 30);
  EXPECT_NEAR(alpha_at(cast(request), 16, 16), 255 * (1 - std::exp(-30 * (kBall - 0.002))), 3);
}

}  // namespace
}  // namespace cellmirror::volume
