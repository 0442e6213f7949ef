// Deformable objects as bytes of a recording and back, and any bytes.
#include "app/recording_layout/tissue_messages.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/recorder/tissue_parts.hpp"

namespace cellmirror::app {
namespace {

constexpr TissueHead kHead{.step = 42, .time = Timestamp{1'000'000'123}, .revision = 3, .has_shape = true};

std::vector<std::byte> bytes_of(const TissueSurface& surface, TissueHead head = kHead) {
  std::vector<std::byte> out;
  EXPECT_TRUE(encode_surface(head, surface, out));
  return out;
}

TEST(TissueMessages, ASurfaceComesBackAsItWas) {
  const TissueSurface surface = test::square("liver.mpo", {10, -20, 30});
  const auto bytes = bytes_of(surface);
  const auto head = read_tissue_head(bytes);
  ASSERT_TRUE(head);
  EXPECT_EQ(head->step, 42U);
  EXPECT_EQ(head->time.ns, 1'000'000'123);
  const auto shape = read_shape(bytes);
  ASSERT_TRUE(shape) << shape.error().text();
  EXPECT_EQ(shape->topology->triangles, surface.topology->triangles);
  EXPECT_EQ(shape->topology->cut_face, surface.topology->cut_face);
  EXPECT_EQ(shape->topology->texture, surface.topology->texture);
  EXPECT_EQ(shape->topology->rgb, surface.topology->rgb);
  const auto back = read_surface(bytes, *shape);
  ASSERT_TRUE(back) << back.error().text();
  EXPECT_EQ(back->name, "liver.mpo");
  EXPECT_TRUE(back->visible && back->wet);
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    // The box has edges of 0.2 m; floats of 30 m have steps of 2 um.
    EXPECT_LT((back->vertices[i] - surface.vertices[i]).norm(), 1e-5F);
    EXPECT_GT(back->normals[i].dot(surface.normals[i]), 0.999F);
    EXPECT_NEAR(back->burn[i], surface.burn[i], 0.005F);
  }
}

TEST(TissueMessages, PlacesWithoutTheirShapeNeedTheShapeOfTheirRevision) {
  TissueSurface surface = test::square("liver.mpo", {0, 0, 0});
  const auto shape = read_shape(bytes_of(surface));
  ASSERT_TRUE(shape);
  surface.vertices[2].x() = 0.15F;
  surface.visible = false;
  TissueHead head = kHead;
  head.has_shape = false;
  const auto moved = read_surface(bytes_of(surface, head), *shape);
  ASSERT_TRUE(moved);
  EXPECT_NEAR(moved->vertices[2].x(), 0.15F, 1e-5F);
  EXPECT_EQ(moved->topology, shape->topology);
  EXPECT_FALSE(moved->visible);
  EXPECT_FALSE(read_shape(bytes_of(surface, head)));
  ++head.revision;
  EXPECT_FALSE(read_surface(bytes_of(surface, head), *shape));
  EXPECT_FALSE(read_surface(bytes_of(surface, head), RecordedShape()));
}

TEST(TissueMessages, WhatIsNotSoundIsNotRecorded) {
  std::vector<std::byte> out;
  TissueSurface surface = test::square("a", {0, 0, 0});
  surface.vertices[1].y() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(encode_surface(kHead, surface, out));
  surface = test::square("a", {0, 0, 0});
  surface.vertices.pop_back();
  EXPECT_FALSE(encode_surface(kHead, surface, out)) << "a triangle names a vertex that is not there";
  EXPECT_FALSE(encode_surface(kHead, TissueSurface(), out));
}

TEST(TissueMessages, CutOffAnywhereTheyAreRefused) {
  const auto bytes = bytes_of(test::square("liver.mpo", {0, 0, 0}));
  const auto shape = read_shape(bytes);
  ASSERT_TRUE(shape);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto part = std::span(bytes).first(size);
    EXPECT_FALSE(read_shape(part)) << size;
  }
  auto wrong = bytes;
  wrong[0] = std::byte{2};
  EXPECT_FALSE(read_tissue_head(wrong)) << "another version";
}

TEST(TissueMessages, ClipsDropsSmokeAndPoolComeBack) {
  TissueView view;
  view.smoke = 0.25;
  view.lens_fog = 0.5;
  view.clips = {test::clip(0.5), test::clip(-0.5)};
  view.particles.push_back({.at = {1, 2, 3}, .radius_m = 0.002F, .kind = 2, .age = 0.5F});
  view.particles.push_back({.at = {std::numeric_limits<float>::infinity(), 0, 0}});
  view.pool.present = true;
  view.pool.size_m = {0.2F, 0.1F};
  view.pool.level_m = 0.01;
  view.pool.columns = 2;
  view.pool.heights_m = {0, 0.001F, 0, 0.002F};
  std::vector<std::byte> bytes;
  encode_tissue_effects(kHead, view, bytes);
  const auto shapes = read_clip_shapes(bytes);
  ASSERT_TRUE(shapes) << shapes.error().text();
  const auto back = read_tissue_effects(bytes, *shapes);
  ASSERT_TRUE(back) << back.error().text();
  EXPECT_EQ(back->smoke, 0.25);
  EXPECT_EQ(back->lens_fog, 0.5);
  ASSERT_EQ(back->clips.size(), 2U);
  EXPECT_EQ(back->clips[1].X_WC.translation().x(), -0.5);
  EXPECT_EQ(*back->clips[0].vertices, *view.clips[0].vertices);
  EXPECT_TRUE(back->clips[0].closes_vessel);
  ASSERT_EQ(back->particles.size(), 1U) << "one was not finite";
  EXPECT_EQ(back->particles[0].kind, 2);
  EXPECT_TRUE(back->pool.present);
  EXPECT_EQ(back->pool.heights_m, view.pool.heights_m);
  // Without their shapes they are not shown.
  const auto without = read_tissue_effects(bytes, RecordedClipShapes());
  ASSERT_TRUE(without);
  EXPECT_TRUE(without->clips.empty());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(read_clip_shapes(std::span(bytes).first(size))) << size;
}

}  // namespace
}  // namespace cellmirror::app
