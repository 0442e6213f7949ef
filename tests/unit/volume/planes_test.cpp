#include "rt_core/volume/planes.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace cellmirror::volume {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;

TEST(VolumePlanes, NormalsGoByElevationAndAzimuth) {
  EXPECT_TRUE(normal_of({}).isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(normal_of({.azimuth_rad = kQuarter}).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_TRUE(normal_of({.elevation_rad = kQuarter}).isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
  const Eigen::Vector3d slanted = normal_of({.elevation_rad = 0.3, .azimuth_rad = -0.8});
  EXPECT_NEAR(slanted.norm(), 1, 1e-12);
  EXPECT_NEAR(std::asin(slanted.z()), 0.3, 1e-12);
}

TEST(VolumePlanes, ActiveKeepsWhatIsNearerReverseTheOther) {
  VolumeSettings settings;
  EXPECT_TRUE(clipping(settings).empty());
  settings.planes[2] = {.side = VolumePlaneSide::beyond, .distance_m = 0.01};
  settings.planes[4] = {.side = VolumePlaneSide::before, .distance_m = -0.02};
  settings.planes[5] = {.side = VolumePlaneSide::none, .framed = true};
  const auto kept = clipping(settings);
  ASSERT_EQ(kept.size(), 2U);
  const auto keeps = [&](double x) {
    return std::ranges::all_of(kept, [&](const HalfSpace& h) { return h.normal.x() * x <= h.distance; });
  };
  EXPECT_TRUE(keeps(0.0) && keeps(-0.019) && keeps(0.009));
  EXPECT_FALSE(keeps(0.011) || keeps(-0.021));
  settings.planes[2].distance_m = std::nan("");
  EXPECT_EQ(clipping(settings).size(), 1U);
}

TEST(VolumePlanes, OutlinesLieInPlaneAndBox) {
  const Eigen::Vector3d half(0.1, 0.2, 0.3);
  for (double e = -1.5; e < 1.6; e += 0.37) {
    for (double a = -1.5; a < 1.6; a += 0.41) {
      for (const double d : {-0.15, 0.0, 0.08}) {
        const VolumePlane plane{.elevation_rad = e, .azimuth_rad = a, .distance_m = d};
        const auto corners = outline(plane, half);
        ASSERT_TRUE(corners.empty() || (corners.size() >= 3 && corners.size() <= 6));
        const Eigen::Vector3d n = normal_of(plane);
        double area = 0;
        for (std::size_t i = 0; i < corners.size(); ++i) {
          EXPECT_NEAR(n.dot(corners[i]), d, 1e-12);
          EXPECT_TRUE((corners[i].cwiseAbs().array() <= half.array() + 1e-12).all());
          const Eigen::Vector3d& next = corners[(i + 1) % corners.size()];
          const double part = n.dot((corners[i] - corners[0]).cross(next - corners[0]));
          EXPECT_GE(part, -1e-12);  // convex, in order
          area += part / 2;
        }
        EXPECT_TRUE(corners.empty() || area > 0);
      }
    }
  }
}

TEST(VolumePlanes, OutlineOfAMiddlePlaneIsTheBoxesSection) {
  const auto corners = outline({}, {0.1, 0.2, 0.3});
  ASSERT_EQ(corners.size(), 4U);
  for (const Eigen::Vector3d& p : corners) EXPECT_TRUE(p.cwiseAbs().isApprox(Eigen::Vector3d(0, 0.2, 0.3), 1e-12));
  EXPECT_TRUE(outline({.distance_m = 0.11}, {0.1, 0.2, 0.3}).empty());
}

}  // namespace
}  // namespace cellmirror::volume
