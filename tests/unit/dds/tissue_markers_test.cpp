// What becomes of deforming surfaces and forces on instruments: markers of few enough triangles.
#include "drivers/dds/tissue_markers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <set>

namespace cellmirror::dds::test {
namespace {

constexpr std::int64_t kLifetime = 2'000'000'000;

// A torus of `sides` times `sides` squares, each of two triangles: closed, and no cell of a grid holds it all.
TissueSurface torus(std::uint32_t sides) {
  TissueSurface surface;
  surface.name = "liver";
  auto topology = std::make_shared<TissueTopology>();
  for (std::uint32_t i = 0; i < sides; ++i) {
    for (std::uint32_t j = 0; j < sides; ++j) {
      const double a = 2 * std::numbers::pi * i / sides;
      const double b = 2 * std::numbers::pi * j / sides;
      const double r = 0.1 + 0.03 * std::cos(b);
      surface.vertices.push_back(Eigen::Vector3d(r * std::cos(a), r * std::sin(a), 0.03 * std::sin(b)).cast<float>());
      const auto at = [&](std::uint32_t x, std::uint32_t y) { return x % sides * sides + y % sides; };
      topology->triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      topology->triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  topology->cut_face.assign(topology->triangles.size(), 0);
  surface.topology = topology;
  return surface;
}

const Marker* find(const MarkerArray& message, const std::string& ns, std::int32_t id = 0) {
  for (const Marker& marker : message.markers)
    if (marker.ns == ns && marker.id == id) return &marker;
  return nullptr;
}

double area(const std::vector<MarkerPoint>& corners) {
  double sum = 0;
  const auto at = [&](std::size_t i) { return Eigen::Vector3d(corners[i][0], corners[i][1], corners[i][2]); };
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    sum += (at(i + 1) - at(i)).cross(at(i + 2) - at(i)).norm() / 2;
  return sum;
}

TEST(TissueMarkers, ASmallSurfaceIsSentAsItIs) {
  TissueView view;
  view.surfaces = {torus(10)};
  TissueMarkers sut(10'000, kLifetime);
  MarkerArray message;
  sut.fill({1, 2}, view, {}, message);
  ASSERT_EQ(message.markers.size(), 1U);
  const Marker& marker = message.markers[0];
  EXPECT_EQ(marker.ns, "tissue");
  EXPECT_EQ(marker.type, MarkerType::triangle_list);
  EXPECT_EQ(marker.header.frame_id, "world");
  EXPECT_EQ(marker.header.stamp, (RosTime{1, 2}));
  EXPECT_EQ(marker.lifetime_ns, kLifetime);
  EXPECT_EQ(marker.points.size(), 3U * 200U);
  EXPECT_NEAR(marker.points[0][0], 0.13, 1e-6);
}

TEST(TissueMarkers, FacesOfCutsAreRedAndHiddenObjectsAreNotThere) {
  TissueView view;
  view.surfaces = {torus(10), torus(10)};
  auto topology = std::make_shared<TissueTopology>(*view.surfaces[0].topology);
  topology->cut_face[3] = topology->cut_face[7] = 1;
  topology->rgb.assign(view.surfaces[0].vertices.size(), {0.5F, 0.25F, 1.0F});
  view.surfaces[0].topology = topology;
  view.surfaces[1].visible = false;
  TissueMarkers sut(10'000, kLifetime);
  MarkerArray message;
  sut.fill({}, view, {}, message);
  ASSERT_EQ(message.markers.size(), 2U);
  ASSERT_NE(find(message, "tissue_cut"), nullptr);
  EXPECT_EQ(find(message, "tissue_cut")->points.size(), 6U);
  EXPECT_GT(find(message, "tissue_cut")->colour[0], 3 * find(message, "tissue_cut")->colour[1]);
  EXPECT_EQ(find(message, "tissue")->points.size(), 3U * 198U);
  EXPECT_EQ(find(message, "tissue")->colour, (MarkerColour{0.5F, 0.25F, 1.0F, 1.0F}));
}

TEST(TissueMarkers, ALargeSurfaceKeepsItsShapeWithFewTriangles) {
  TissueView view;
  view.surfaces = {torus(200)};  // 80,000 triangles
  TissueMarkers sut(5'000, kLifetime);
  MarkerArray message;
  sut.fill({}, view, {}, message);
  ASSERT_EQ(message.markers.size(), 1U);
  const std::size_t triangles = message.markers[0].points.size() / 3;
  EXPECT_LE(triangles, 5'000U);
  EXPECT_GE(triangles, 1'000U);
  const double exact = 4 * std::numbers::pi * std::numbers::pi * 0.1 * 0.03;
  EXPECT_NEAR(area(message.markers[0].points), exact, 0.1 * exact);
}

TEST(TissueMarkers, TheSameTrianglesStayWhileTheSurfaceMoves) {
  TissueView view;
  view.surfaces = {torus(60)};
  TissueMarkers sut(1'000, kLifetime);
  MarkerArray before;
  sut.fill({}, view, {}, before);
  for (Eigen::Vector3f& vertex : view.surfaces[0].vertices) vertex += Eigen::Vector3f(0.0037F, -0.011F, 0.5F);
  MarkerArray after;
  sut.fill({}, view, {}, after);
  ASSERT_EQ(before.markers[0].points.size(), after.markers[0].points.size());
  for (std::size_t i = 0; i < before.markers[0].points.size(); ++i) {
    EXPECT_NEAR(after.markers[0].points[i][0] - before.markers[0].points[i][0], 0.0037, 1e-6);
    EXPECT_NEAR(after.markers[0].points[i][2] - before.markers[0].points[i][2], 0.5, 1e-6);
  }
}

TEST(TissueMarkers, AllObjectsTogetherStayWithinTheBound) {
  TissueView view;
  for (int i = 0; i < 5; ++i) view.surfaces.push_back(torus(60));
  TissueMarkers sut(3'000, kLifetime);
  MarkerArray message;
  sut.fill({}, view, {}, message);
  ASSERT_EQ(message.markers.size(), 5U);
  std::size_t points = 0;
  for (const Marker& marker : message.markers) points += marker.points.size();
  EXPECT_LE(points, 3U * 3'000U);
}

TEST(TissueMarkers, WhatIsNotFiniteOrDoesNotFitIsLeftOut) {
  TissueView view;
  view.surfaces = {torus(10), torus(10), TissueSurface{}};
  view.surfaces[0].vertices[0].x() = std::numeric_limits<float>::quiet_NaN();
  view.surfaces[1].vertices.pop_back();  // fewer than its triangles name
  TissueMarkers sut(10'000, kLifetime);
  MarkerArray message;
  sut.fill({}, view, {}, message);
  ASSERT_EQ(message.markers.size(), 1U);
  EXPECT_EQ(message.markers[0].id, 0);
  EXPECT_EQ(message.markers[0].points.size(), 3U * (200U - 6U)) << "six triangles have that corner";
  TissueMarkers few(50, kLifetime);
  few.fill({}, view, {}, message);
  for (const Marker& marker : message.markers)
    for (const MarkerPoint& point : marker.points)
      for (const double axis : point) EXPECT_TRUE(std::isfinite(axis));
}

TEST(TissueMarkers, ForcesAreArrowsFromTheToolCentrePoint) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<TissueForceArrow> forces = {{"A", {1, 2, 3}, {0, 0, -2}},
                                                {"B", {0, 0, 0}, {1e4, 0, 0}},
                                                {"C", {0, 0, 0}, {1e-4, 0, 0}},
                                                {"D", {0, nan, 0}, {1, 0, 0}},
                                                {"E", {0, 0, 0}, {nan, 0, 0}}};
  TissueMarkers sut(100, kLifetime);
  MarkerArray message;
  sut.fill({}, TissueView{}, forces, message);
  ASSERT_EQ(message.markers.size(), 2U);
  const Marker& arrow = message.markers[0];
  EXPECT_EQ(arrow.ns, "tissue_forces");
  EXPECT_EQ(arrow.type, MarkerType::arrow);
  ASSERT_EQ(arrow.points.size(), 2U);
  EXPECT_EQ(arrow.points[0], (MarkerPoint{1, 2, 3}));
  EXPECT_NEAR(arrow.points[1][2], 3 - 0.04, 1e-12);
  EXPECT_NEAR(message.markers[1].points[1][0], 0.2, 1e-12) << "not longer";
}

}  // namespace
}  // namespace cellmirror::dds::test
