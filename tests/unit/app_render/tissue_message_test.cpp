// Deformable objects for clients that draw them: byte by byte, bounded, and nothing of what does not fit together.
#include "app/render/tissue_message.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>
#include <memory>
#include <string>

namespace cellmirror::app {
namespace {

std::uint32_t word(const std::string& bytes, std::size_t index) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + 4 * index, 4);
  return value;
}
float number(const std::string& bytes, std::size_t index) { return std::bit_cast<float>(word(bytes, index)); }

// A triangle of skin and one of a cut, and a clip of one triangle.
TissueView view() {
  auto topology = std::make_shared<TissueTopology>();
  topology->triangles = {{0, 2, 3}, {0, 1, 2}};
  topology->cut_face = {1, 0};
  topology->rgb.assign(4, {1.0F, 0.0F, 0.5F});
  TissueView out;
  TissueSurface& surface = out.surfaces.emplace_back();
  surface.topology = topology;
  surface.vertices = {{1, 2, 3}, {3, 2, 4}, {1, 2, 3.5F}, {3, 2, 3}};
  surface.normals = {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  surface.burn = {0, 1, 2, std::numeric_limits<float>::quiet_NaN()};
  TissueClip& clip = out.clips.emplace_back();
  clip.X_WC.translation().z() = 1;
  clip.vertices =
      std::make_shared<std::vector<Eigen::Vector3f>>(std::vector<Eigen::Vector3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  clip.triangles =
      std::make_shared<std::vector<std::array<std::uint32_t, 3>>>(std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}});
  out.particles.push_back({.at = {0.5F, 0.25F, 0.125F}, .radius_m = 0.002F, .kind = 2});
  out.pool.present = true;
  out.pool.size_m = {0.2F, 0.1F};
  out.pool.level_m = 0.01;
  out.pool.rgba = {1, 0, 0, 1};
  return out;
}

TEST(TissueMessage, HasTheShapeWithCutFacesLast) {
  const std::string bytes = tissue_shape(view(), 7);
  ASSERT_EQ(bytes.size(), 4U * (4 + 3 + 6 + 4 + 2 + 9 + 3));
  EXPECT_EQ(bytes.substr(0, 4), "CMT1");
  for (const auto& [index, value] : {std::pair(1U, 7U),
                                     {2U, 1U},
                                     {3U, 1U},
                                     {4U, 4U},
                                     {5U, 2U},
                                     {6U, 1U},
                                     {7U, 0U},
                                     {8U, 1U},
                                     {9U, 2U},
                                     {10U, 0U},
                                     {11U, 2U},
                                     {12U, 3U},
                                     {13U, 0x008000FFU},
                                     {17U, 3U},
                                     {18U, 1U}})
    EXPECT_EQ(word(bytes, index), value) << index;
  EXPECT_EQ(number(bytes, 22), 1.0F);
}

TEST(TissueMessage, HasTheMotionInItsBox) {
  const std::string bytes = tissue_motion(view(), 7);
  ASSERT_EQ(bytes.size(), 4U * (6 + 7 + 6 + 2 + 1 + 7 + 5 + 11));
  EXPECT_EQ(bytes.substr(0, 4), "CMM1");
  for (std::size_t i = 2; i < 6; ++i) EXPECT_EQ(word(bytes, i), 1U);
  EXPECT_EQ(number(bytes, 6), 1.0F);
  EXPECT_EQ(number(bytes, 9), 2.0F) << "edge along x";
  EXPECT_EQ(word(bytes, 12), 3U) << "shown and wet";
  EXPECT_EQ(word(bytes, 13), 0U);
  EXPECT_EQ(word(bytes, 14), 0xFFFF0000U) << "the second vertex is at the other end along x";
  EXPECT_EQ(word(bytes, 19), 0x007F0000U) << "normals along z and x";
  EXPECT_EQ(word(bytes, 21), 0x00FF8000U) << "burns: raw, coagulated, charred, and what is no number";
  EXPECT_EQ(number(bytes, 24), 1.0F) << "pose of the clip";
  EXPECT_EQ(number(bytes, 29), 0.5F);
  EXPECT_EQ(word(bytes, 33), 2U) << "water";
  EXPECT_EQ(word(bytes, 44), 0xFF0000FFU) << "colour of the pool";
}

TEST(TissueMessage, IsTheSameShapeUntilSomethingIsCutOrClipped) {
  TissueView now = view();
  const TissueShapeKey key = tissue_shape_key(now);
  now.surfaces[0].vertices[0].x() = 0;
  EXPECT_EQ(tissue_shape_key(now), key);
  TissueView cut = now;
  cut.surfaces[0].topology = std::make_shared<TissueTopology>(*now.surfaces[0].topology);
  EXPECT_NE(tissue_shape_key(cut), key);
  TissueView clipped = now;
  clipped.clips.push_back(now.clips[0]);
  EXPECT_NE(tissue_shape_key(clipped), key);
}

TEST(TissueMessage, LeavesOutWhatDoesNotFitTogether) {
  TissueView wrong = view();
  auto topology = std::make_shared<TissueTopology>(*wrong.surfaces[0].topology);
  topology->triangles[0] = {0, 1, 4};
  wrong.surfaces[0].topology = topology;
  EXPECT_EQ(word(tissue_shape(wrong, 1), 4), 0U) << "a corner beyond the vertices";
  TissueView without = view();
  without.surfaces[0].normals.pop_back();
  EXPECT_EQ(word(tissue_shape(without, 1), 2), 0U);
  TissueView far = view();
  far.surfaces[0].vertices[1].x() = 1e9F;
  EXPECT_EQ(word(tissue_motion(far, 1), 12) & 1U, 0U) << "exploded tissue is not shown";
  far.surfaces[0].vertices[1].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(word(tissue_motion(far, 1), 12) & 1U, 0U);
}

TEST(TissueMessage, IsBounded) {
  TissueView many = view();
  many.particles.resize(5 * kMostTissueParticles);
  many.clips.resize(5 * kMostTissueClips);
  many.surfaces.resize(5 * kMostTissueSurfaces, many.surfaces[0]);
  const std::string motion = tissue_motion(many, 1);
  EXPECT_EQ(word(motion, 2), kMostTissueSurfaces);
  EXPECT_EQ(word(motion, 3), kMostTissueClips);
  EXPECT_EQ(word(motion, 4), kMostTissueParticles);
  TissueSurface huge = view().surfaces[0];
  huge.vertices.resize(kMostTissueVertices, Eigen::Vector3f::Zero());
  huge.normals.resize(kMostTissueVertices, Eigen::Vector3f::UnitX());
  many.surfaces = {huge, huge};
  EXPECT_EQ(word(tissue_motion(many, 1), 2), 1U);
}

}  // namespace
}  // namespace cellmirror::app
