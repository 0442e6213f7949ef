// Normals, edges, views, blurring and text, without OpenGL.
#include <gtest/gtest.h>

#include "drivers/display/internal/picture_text.hpp"
#include "drivers/display/internal/primitives.hpp"
#include "drivers/display/internal/shadow_map.hpp"
#include "drivers/display/internal/surface.hpp"
#include "drivers/display/internal/view_transform.hpp"
#include "tests/unit/display/test_scenes.hpp"

namespace cellmirror::display {
namespace {

TEST(DisplaySurface, ABoxKeepsItsEdgesAndATorusIsRound) {
  EXPECT_EQ(smooth_surface(unit_box()).vertices.size(), 24U);  // three normals a corner
  const auto ring = torus(1, 0.3, 48, 24);
  EXPECT_EQ(smooth_surface(*ring).vertices.size(), ring->vertices.size());
  EXPECT_EQ(flat_surface(*ring).vertices.size(), 3 * ring->triangles.size());
}

TEST(DisplaySurface, NormalsPointOutwards) {
  for (const geometry::TriangleMesh& mesh : {unit_box(), unit_sphere(), unit_cylinder(), capsule(0.3, 1)}) {
    for (const Vertex& vertex : smooth_surface(mesh).vertices) {
      EXPECT_NEAR(vertex.normal.norm(), 1, 1e-5);
      EXPECT_GT(vertex.normal.dot(vertex.position), 0);
    }
  }
  for (const Vertex& vertex : smooth_surface(unit_sphere()).vertices)
    EXPECT_GT(vertex.normal.dot(vertex.position.normalized()), 0.99F);
}

TEST(DisplaySurface, AVertexOfManyFacesStaysBounded) {
  geometry::TriangleMesh fan;  // each face in another plane
  constexpr std::uint32_t kFaces = 4000;
  fan.vertices.emplace_back(0, 0, 0);
  for (std::uint32_t i = 0; i < kFaces; ++i) {
    const double turn = 0.7 * i;
    fan.vertices.emplace_back(std::cos(turn), std::sin(turn), std::cos(3.1 * i));
    fan.vertices.emplace_back(std::cos(turn + 1), std::sin(turn + 1), std::sin(5.3 * i));
    fan.triangles.push_back({0, 2 * i + 1, 2 * i + 2});
  }
  EXPECT_LE(smooth_surface(fan).vertices.size(), 2 * kFaces + 32);
}

TEST(DisplaySurface, AWireframeOfABoxHasTwelveEdges) {
  EXPECT_EQ(feature_edges(unit_box()).size(), 12U);
  geometry::TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(feature_edges(sheet).size(), 4U);
}

TEST(DisplaySurface, BoundsHoldAll) {
  const BoundingSphere sut = bounding_sphere(unit_box());
  EXPECT_NEAR(sut.radius, std::sqrt(0.75), 1e-9);
  EXPECT_NEAR(sut.centre.norm(), 0, 1e-9);
  EXPECT_EQ(bounding_sphere({}).radius, 0);
}

TEST(DisplayView, TheLookpointIsInTheMiddle) {
  const auto sut = ViewTransform::of(pane_looking_at({3, -4, 2}, {0.5, 0.2, 0.1}), 320, 200);
  ASSERT_TRUE(sut);
  const Eigen::Vector2d pixel = sut->pixel(sut->clip({0.5, 0.2, 0.1}));
  EXPECT_NEAR(pixel.x(), 160, 1e-6);
  EXPECT_NEAR(pixel.y(), 100, 1e-6);
  EXPECT_LT(sut->pixel(sut->clip({0.5, 0.2, 0.6})).y(), 100);
}

TEST(DisplayView, TheOpeningAngleIsThatOfThePictureUpAndDown) {
  const auto sut = ViewTransform::of(pane_looking_at({0, -10, 0}, {0, 0, 0}, 0.7), 320, 200);
  ASSERT_TRUE(sut);
  EXPECT_NEAR(sut->pixel(sut->clip({0, 0, 10 * std::tan(0.35)})).y(), 0, 1e-6);
  EXPECT_NEAR(sut->metres_per_pixel(10), 20 * std::tan(0.35) / 200, 1e-9);
}

TEST(DisplayView, SeesWhatIsInThePicture) {
  const auto sut = ViewTransform::of(pane_looking_at({0, -10, 0}, {0, 0, 0}, 0.7), 200, 200);
  ASSERT_TRUE(sut);
  EXPECT_TRUE(sut->sees({0, 0, 0}, 0.1));
  EXPECT_FALSE(sut->sees({0, -11, 0}, 0.1));
  EXPECT_FALSE(sut->sees({6, 0, 0}, 1));
  EXPECT_TRUE(sut->sees({4, 0, 0}, 1));
}

TEST(DisplayShadow, BlurringKeepsTheAmountAndSpreadsIt) {
  constexpr int kEdge = 65;
  std::vector<std::uint8_t> sut(kEdge * kEdge, 0);
  for (int y = 22; y < 43; ++y) {
    for (int x = 22; x < 43; ++x) sut[static_cast<std::size_t>(y * kEdge + x)] = 255;
  }
  blur(sut, kEdge, 3);
  double sum = 0;
  for (const std::uint8_t value : sut) sum += value;
  EXPECT_NEAR(sum / 255, 21 * 21, 12);
  EXPECT_GT(sut[32 * kEdge + 32], 240);
  EXPECT_NEAR(sut[32 * kEdge + 22], 140, 40);
  EXPECT_EQ(sut[0], 0);
  EXPECT_NEAR(sut[32 * kEdge + 20], sut[20 * kEdge + 32], 2);
}

TEST(DisplayText, AStickerIsCutAtTheEdges) {
  Image picture{4, 4, std::vector<std::uint8_t>(64, 100)};
  Sticker sticker{3, 3, std::vector<std::uint8_t>(36, 255)};
  for (const int at : {-2, 3, -100, 100}) stick(picture, {0, 0, 4, 4}, sticker, at, at);
  EXPECT_EQ(picture.pixel(0, 0)[0], 255);
  EXPECT_EQ(picture.pixel(1, 1)[0], 100);
  EXPECT_EQ(picture.pixel(3, 3)[0], 255);
}

}  // namespace
}  // namespace cellmirror::display
