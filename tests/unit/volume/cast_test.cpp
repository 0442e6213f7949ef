// Pictures of volumes against what formulas say.
#include <numbers>

#include "tests/unit/volume/casting.hpp"

namespace cellmirror::volume {
namespace {

constexpr int kEdge = 160;
constexpr double kQuarter = std::numbers::pi / 2;

double level_of(double extinction, double length) { return 255 * (1 - std::exp(-extinction * length)); }

// A ball of 60 mm with an even density and a soft border.
constexpr double kRadius = 0.06;
constexpr double kBorder = 0.02;

// So smooth that a millimetre is short.
double soft_inside(double inside) {
  const double x = phantoms::part_inside(inside, kBorder);
  return x * x * x * (x * (6 * x - 15) + 10);
}

template <class T>
std::shared_ptr<VoxelGrid> ball(std::uint32_t size, double high, double low = 0) {
  const double spacing = 0.16 / size;
  return phantoms::grid_of<T>({size, size, size}, Eigen::Vector3d::Constant(spacing), [&](const Eigen::Vector3d& p) {
    return low + (high - low) * soft_inside(kRadius - p.norm());
  });
}

// Of the density along a ray, in metres of full density.
double length_through_ball(const Ray& ray) {
  const double beside = ray.origin.cross(ray.direction).norm();
  const double middle = -ray.origin.dot(ray.direction);
  constexpr int kParts = 4000;
  constexpr double kReach = kRadius + kBorder;
  double sum = 0;
  for (int i = 0; i < kParts; ++i) {
    const double along = middle + (2 * (i + 0.5) / kParts - 1) * kReach;
    sum += soft_inside(kRadius - std::hypot(beside, along - middle)) * 2 * kReach / kParts;
  }
  return sum;
}

struct BallCase {
  std::string name;
  std::shared_ptr<VoxelGrid> grid;
  phantoms::Camera camera;
  double per_metre = 10;
  CastQuality quality = kEvenQuality;
};
void PrintTo(const BallCase& ball, std::ostream* out) { *out << ball.name; }

class Ball : public testing::TestWithParam<BallCase> {};

TEST_P(Ball, IsAsOpaqueAsItsChord) {
  const BallCase& c = GetParam();
  CastRequest request = request_of(c.grid, c.camera, kEdge, kEdge);
  request.settings = linear_settings(*c.grid, c.per_metre);
  request.quality = c.quality;
  const VolumePicture sut = cast(request);
  double worst = 0;
  for (int y = 0; y < kEdge; y += 3) {
    for (int x = 0; x < kEdge; x += 3) {
      const double expected = level_of(c.per_metre, length_through_ball(ray_of(request, x, y)));
      worst = std::max(worst, std::abs(alpha_at(sut, x, y) - expected));
    }
  }
  EXPECT_LE(worst, 1.0);
}

const phantoms::Camera kPerspective{.from = Eigen::Vector3d(0.1, -0.4, 0.2)};
const phantoms::Camera kParallel{.from = Eigen::Vector3d(-0.3, -0.2, 0.1), .height_m = 0.2};

INSTANTIATE_TEST_SUITE_P(
    All, Ball,
    testing::Values(BallCase{"bytes", ball<std::uint8_t>(200, 255), kPerspective},
                    BallCase{"signed", ball<std::int16_t>(200, 3000, -1000), kPerspective},
                    BallCase{"unsigned", ball<std::uint16_t>(200, 65000), kPerspective},
                    BallCase{"parallel", ball<std::int16_t>(200, 30000, -30000), kParallel},
                    BallCase{"dense", ball<std::uint16_t>(200, 4000), kPerspective, 60},
                    BallCase{"thin", ball<std::uint16_t>(200, 4000), kPerspective, 1},
                    BallCase{"half steps",
                             ball<std::uint16_t>(200, 4000),
                             kPerspective,
                             20,
                             {.step_voxels = 0.5, .long_steps = {0, 0, 0}, .coarse = CoarseVoxels::never}},
                    BallCase{"long steps", ball<std::uint16_t>(200, 4000), kPerspective, 8, kFullQuality}));

std::shared_ptr<VoxelGrid> block(std::array<std::uint32_t, 3> size, const Eigen::Vector3d& spacing) {
  return phantoms::grid_of<std::uint8_t>(size, spacing, [](const Eigen::Vector3d&) { return 100.0; });
}

double length_in_box(const Ray& ray, const Eigen::Vector3d& half,
                     const std::function<bool(const Eigen::Vector3d&)>& keeps) {
  constexpr int kParts = 20'000;
  const double reach = ray.origin.norm() + half.norm();
  double sum = 0;
  for (int i = 0; i < kParts; ++i) {
    const Eigen::Vector3d p = ray.origin + reach * (i + 0.5) / kParts * ray.direction;
    if ((p.cwiseAbs().array() <= half.array()).all() && keeps(p)) sum += reach / kParts;
  }
  return sum;
}

TEST(Planes, KeepTheirHalfSpace) {
  const auto grid = block({60, 40, 50}, {0.002, 0.003, 0.0025});
  for (const VolumePlane plane :
       {VolumePlane{.side = VolumePlaneSide::beyond, .distance_m = 0.013},
        VolumePlane{.side = VolumePlaneSide::before, .distance_m = -0.02},
        VolumePlane{.side = VolumePlaneSide::beyond, .elevation_rad = 0.7, .azimuth_rad = -0.4, .distance_m = 0.005},
        VolumePlane{.side = VolumePlaneSide::before, .elevation_rad = kQuarter}}) {
    CastRequest request = request_of(grid, kPerspective, 40, 40);
    make_even(request, 9);
    request.settings.planes[3] = plane;
    const VolumePicture sut = cast(request);
    const double e = plane.elevation_rad;
    const double a = plane.azimuth_rad;
    const Eigen::Vector3d n(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
    const auto keeps = [&](const Eigen::Vector3d& p) {
      return plane.side == VolumePlaneSide::beyond ? n.dot(p) <= plane.distance_m : n.dot(p) >= plane.distance_m;
    };
    for (int y = 0; y < 40; y += 3) {
      for (int x = 0; x < 40; x += 3) {
        const double expected = level_of(9, length_in_box(ray_of(request, x, y), grid->half_extent_m(), keeps));
        EXPECT_NEAR(alpha_at(sut, x, y), expected, 1.0) << x << ' ' << y;
      }
    }
  }
}

TEST(Planes, ASlabShowsTheValuesOfItsSlice) {
  // Every voxel has a value of its own; a slab of one slice is seen along z, a pixel a voxel.
  constexpr std::uint32_t kSize = 32;
  constexpr double kSpacing = 0.001;
  const auto value = [](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    return (37 * i + 101 * j + 59 * k) % 200;
  };
  auto grid = std::make_shared<VoxelGrid>();
  grid->size = {kSize, kSize, kSize};
  grid->spacing_m.setConstant(kSpacing);
  std::vector<std::uint8_t> values;
  for (std::uint32_t k = 0; k < kSize; ++k) {
    for (std::uint32_t j = 0; j < kSize; ++j) {
      for (std::uint32_t i = 0; i < kSize; ++i) values.push_back(static_cast<std::uint8_t>(value(i, j, k)));
    }
  }
  grid->values = std::move(values);
  for (const std::uint32_t k : {1U, 7U, 16U, 30U}) {
    const double z = (k - 15.5) * kSpacing;
    phantoms::Camera camera{
        .from = Eigen::Vector3d(0, 0, 1), .up = Eigen::Vector3d::UnitY(), .height_m = kSize * kSpacing};
    CastRequest request = request_of(grid, camera, kSize, kSize);
    request.settings.table = VolumeTable::linear;
    request.settings.parameters[1].opacity = 3;
    const double per_metre = 3 * 40 / (kSize * kSpacing);
    const double thick = 0.2 * kSpacing;
    request.settings.planes[0] = {
        .side = VolumePlaneSide::beyond, .elevation_rad = kQuarter, .distance_m = z + thick / 2};
    request.settings.planes[1] = {
        .side = VolumePlaneSide::before, .elevation_rad = kQuarter, .distance_m = z - thick / 2};
    const VolumePicture sut = cast(request);
    for (std::uint32_t j = 0; j < kSize; ++j) {
      for (std::uint32_t i = 0; i < kSize; ++i) {
        // Rows of the picture go down, y goes up.
        const double expected = level_of(per_metre * value(i, j, k) / 199.0, thick);
        EXPECT_NEAR(alpha_at(sut, static_cast<int>(i), static_cast<int>(kSize - 1 - j)), expected, 1.0)
            << i << ' ' << j << ' ' << k;
      }
    }
  }
}

TEST(Steps, OfAnyLengthGiveTheSameOpacity) {
  const auto grid = block({50, 50, 50}, Eigen::Vector3d::Constant(0.002));
  std::vector<VolumePicture> pictures;
  for (const double step : {0.13, 0.5, 1.0, 1.7, 3.0}) {
    CastRequest request = request_of(grid, kPerspective, 64, 64);
    make_even(request, 12);
    request.quality.step_voxels = step;
    pictures.push_back(cast(request));
  }
  for (const VolumePicture& picture : pictures) {
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4) EXPECT_NEAR(picture.rgba[i], pictures[0].rgba[i], 1.0);
  }
}

TEST(Bricks, SkippingChangesNothing) {
  // Small balls in much air, which most rays leap over; the same with a trace of opacity everywhere.
  const auto value = [](const Eigen::Vector3d& p) {
    const Eigen::Vector3d cell(std::remainder(p.x(), 0.05), std::remainder(p.y(), 0.05), std::remainder(p.z(), 0.05));
    return 200 * phantoms::part_inside(0.006 - cell.norm(), 0.004);
  };
  const auto grid = phantoms::grid_of<std::uint8_t>({130, 120, 140}, Eigen::Vector3d::Constant(0.001), value);
  CastRequest request = request_of(grid, kPerspective, 200, 200);
  request.settings = linear_settings(*grid, 300);
  request.quality = kEvenQuality;
  const VolumePicture skipped = cast(request);
  EXPECT_LT(skipped.bricks_drawn, skipped.bricks / 2);
  VolumeUserTable rows;
  const double longest = 2 * grid->half_extent_m().maxCoeff();
  const auto opacity = static_cast<float>(300 * longest / 40 / 3);
  rows.rows = {{0, {0, 0, 0}, 1e-6F}, {200, {1, 1, 1}, opacity}};
  request.user[0] = std::make_shared<const VolumeUserTable>(rows);
  request.settings.table = VolumeTable::user1;
  request.settings.parameters[static_cast<std::size_t>(VolumeTable::user1)].opacity = 3;
  const VolumePicture all = cast(request);
  EXPECT_EQ(all.bricks_drawn, all.bricks);
  ASSERT_EQ(skipped.rgba.size(), all.rgba.size());
  int greatest = 0;
  for (std::size_t i = 3; i < all.rgba.size(); i += 4) greatest = std::max(greatest, int{all.rgba[i]});
  EXPECT_GT(greatest, 200);
  for (std::size_t i = 3; i < all.rgba.size(); i += 4) EXPECT_NEAR(skipped.rgba[i], all.rgba[i], 1);
}

TEST(Quality, LongStepsAndHasteStayNearTheEvenPicture) {
  const auto grid = phantoms::trunk_grid(96);
  const auto picture_of = [&](const CastQuality& quality) {
    CastRequest request = request_of(grid, {.from = Eigen::Vector3d(0.4, -0.8, 0.2)}, 160, 160);
    request.quality = quality;
    request.quality.light = false;
    return cast(request);
  };
  const VolumePicture even = picture_of(kEvenQuality);
  const auto mean_difference = [&](const VolumePicture& other) {
    double sum = 0;
    for (std::size_t i = 0; i < even.rgba.size(); ++i) sum += std::abs(even.rgba[i] - other.rgba[i]);
    return sum / static_cast<double>(even.rgba.size());
  };
  EXPECT_LT(mean_difference(picture_of(kFullQuality)), 1.0);
  EXPECT_LT(mean_difference(picture_of(kHastyQuality)), 4.0);
  VolumePicture nothing = even;
  std::ranges::fill(nothing.rgba, std::uint8_t{0});
  EXPECT_GT(mean_difference(nothing), 8.0);
}

TEST(Threads, ManyGiveThePictureOfOne) {
  const auto grid = phantoms::trunk_grid(64);
  const CastRequest request = request_of(grid, {.from = Eigen::Vector3d(0.4, -0.8, 0.2)}, 200, 150);
  const VolumePicture one = cast(request, 0);
  const VolumePicture many = cast(request, 5);
  EXPECT_EQ(one.rgba, many.rgba);
  EXPECT_EQ(one.depth, many.depth);
}

}  // namespace
}  // namespace cellmirror::volume
