// Voxel volumes in the picture: opacity, depth in both directions, panes, picks, frames of planes, resolution.
#include "rt_core/geometry/shape.hpp"
#include "rt_core/ports/voxel_grid.hpp"
#include "tests/support/volume/phantoms.hpp"
#include "tests/unit/display/renderer_fixture.hpp"

namespace cellmirror::display {
namespace {

constexpr std::uint32_t kVolume = 77;  // object number

// Cubes of 1 m each way, 50 pixels in the views of the fixture.
class Volumes : public RendererTest {
 protected:
  static std::shared_ptr<const VoxelGrid> cube() {
    static const std::shared_ptr<const VoxelGrid> kCube = phantoms::grid_of<std::uint8_t>(
        {40, 40, 40}, Eigen::Vector3d::Constant(0.025), [](const Eigen::Vector3d&) { return 100.0; });
    return kCube;
  }
  // Red, with so much extinction.
  static SceneVolume red_cube(double per_metre) {
    SceneVolume shown;
    shown.object = kVolume;
    shown.grid = cube();
    shown.settings.table = VolumeTable::user1;
    VolumeUserTable table;
    const auto opacity = static_cast<float>(per_metre / 40 / 3);
    table.rows = {{0, {1, 0, 0}, opacity}, {200, {1, 0, 0}, opacity}};
    shown.settings.parameters[static_cast<std::size_t>(VolumeTable::user1)].opacity = 3;
    shown.user_tables[0] = std::make_shared<const VolumeUserTable>(table);
    return shown;
  }
  static Scene scene_of(SceneVolume shown) {
    Scene scene;
    scene.volumes.push_back(std::move(shown));
    return scene;
  }
  static SceneBody ball_at(const Eigen::Vector3d& centre, double radius) {
    SceneBody body;
    body.object = 5;
    body.shape = Shape::sphere;
    body.size = Eigen::Vector3d(radius, 0, 0);
    body.X_WG.translation() = centre;
    body.rgba = {0.1F, 0.9F, 0.1F, 1};
    return body;
  }
  static bool is_red(const std::uint8_t* p) { return p[0] > 200 && p[1] < 40 && p[2] < 40; }
  static bool is_green(const std::uint8_t* p) { return p[1] > p[0] + 60 && p[1] > p[2] + 60; }
};

TEST_F(Volumes, IsAsOpaqueInThePictureAsItIsThick) {
  const Image empty = picture(Scene{});
  const Image sut = picture(scene_of(red_cube(1.2)));
  const double share = 1 - std::exp(-1.2);
  for (const int x : {80, 100, 120}) {
    const std::uint8_t* const p = sut.pixel(x, 100);
    const std::uint8_t* const before = empty.pixel(x, 100);
    EXPECT_NEAR(p[0], before[0] * (1 - share) + 255 * share, 2);
    EXPECT_NEAR(p[1], before[1] * (1 - share), 2);
  }
  EXPECT_EQ(count_different(sut, empty, {0, 0, 74, 200}), 0);
  EXPECT_EQ(count_different(sut, empty, {126, 0, 74, 200}), 0);
}

TEST_F(Volumes, BodiesBeforeItHideItBodiesBehindAreHidden) {
  Scene scene = scene_of(red_cube(200));
  scene.bodies.push_back(ball_at({0, -0.8, 0}, 0.2));
  EXPECT_TRUE(is_green(picture(scene).pixel(100, 100)));
  scene.bodies[0].X_WG.translation().y() = 0.8;
  EXPECT_TRUE(is_red(picture(scene).pixel(100, 100)));
}

TEST_F(Volumes, AnInstrumentDipsIntoIt) {
  // Half of the way through: what is before the ball covers it in part.
  Scene scene = scene_of(red_cube(1.2));
  scene.bodies.push_back(ball_at({0, 0.2, 0}, 0.2));
  Scene alone;
  alone.bodies = scene.bodies;
  const Image uncovered = picture(alone);
  const std::uint8_t* const bare = uncovered.pixel(100, 100);
  const std::array<std::uint8_t, 3> ball = {bare[0], bare[1], bare[2]};
  const Image sut = picture(scene);
  const double share = 1 - std::exp(-1.2 * 0.5);
  EXPECT_NEAR(sut.pixel(100, 100)[0], ball[0] * (1 - share) + 255 * share, 3);
  EXPECT_NEAR(sut.pixel(100, 100)[1], ball[1] * (1 - share), 3);
}

TEST_F(Volumes, LinesBehindAnOpaqueOneAreHidden) {
  Scene scene = scene_of(red_cube(200));
  scene.lines.push_back({.from = {-1, 0.8, 0}, .to = {1, 0.8, 0}, .rgba = {0, 0, 1, 1}, .width_px = 6});
  EXPECT_TRUE(is_red(picture(scene).pixel(100, 100)));
  scene.lines[0].from.y() = scene.lines[0].to.y() = -0.8;
  EXPECT_FALSE(is_red(picture(scene).pixel(100, 100)));
}

TEST_F(Volumes, IsPickedWhereItIsHalfOpaque) {
  Scene scene = scene_of(red_cube(5));
  scene.bodies.push_back(ball_at({-0.3, -0.8, 0}, 0.1));
  scene.bodies.push_back(ball_at({0.3, 0.8, 0}, 0.1));
  const auto at = [](const std::vector<std::uint32_t>& numbers, int x, int y) {
    return numbers[static_cast<std::size_t>(y * kEdge + x)];
  };
  const auto opaque = objects(scene);
  EXPECT_EQ(at(opaque, 100, 100), kVolume);
  EXPECT_EQ(at(opaque, 85, 100), 5U);
  EXPECT_EQ(at(opaque, 115, 100), kVolume);
  EXPECT_EQ(at(opaque, 60, 100), 0U);
  scene.volumes[0] = red_cube(0.5);
  const auto thin = objects(scene);
  EXPECT_EQ(at(thin, 100, 100), 0U);
  EXPECT_EQ(at(thin, 115, 100), 5U);
}

TEST_F(Volumes, SeveralCoverEachOtherByDistance) {
  Scene scene = scene_of(red_cube(200));
  SceneVolume green = red_cube(200);
  VolumeUserTable table = *green.user_tables[0];
  for (VolumeUserRow& row : table.rows) row.rgb = {0, 1, 0};
  green.user_tables[0] = std::make_shared<const VolumeUserTable>(table);
  green.X_WV.translation() = Eigen::Vector3d(0, -1.5, 0);
  green.object = kVolume + 1;
  scene.volumes.push_back(green);
  EXPECT_TRUE(is_green(picture(scene).pixel(100, 100)));
  EXPECT_EQ(objects(scene)[100 * kEdge + 100], kVolume + 1);
  std::swap(scene.volumes[0], scene.volumes[1]);
  EXPECT_TRUE(is_green(picture(scene).pixel(100, 100)));
  scene.volumes[0].X_WV.translation().y() = 1.5;
  EXPECT_TRUE(is_red(picture(scene).pixel(100, 100)));
  EXPECT_EQ(shared()->counters().volumes, 2U);
}

TEST_F(Volumes, PanesShowThemEachFromItsEye) {
  Pane left = level();
  left.width = 0.5;
  Pane right = from_above();
  right.left = 0.5;
  right.width = 0.5;
  SceneVolume shown = red_cube(200);
  shown.X_WV.translation() = Eigen::Vector3d(0, 0, 0.8);
  const Image sut = picture(scene_of(shown), std::vector<Pane>{left, right});
  EXPECT_TRUE(is_red(sut.pixel(50, 60)));
  EXPECT_FALSE(is_red(sut.pixel(50, 100)));
  EXPECT_TRUE(is_red(sut.pixel(150, 100)));
}

TEST_F(Volumes, PlanesCutAndFramesShowThem) {
  SceneVolume shown = red_cube(200);
  shown.settings.planes[0] = {.side = VolumePlaneSide::beyond};  // x <= 0
  const Image cut = picture(scene_of(shown));
  EXPECT_TRUE(is_red(cut.pixel(90, 100)));
  EXPECT_FALSE(is_red(cut.pixel(110, 100)));
  shown.settings.planes[0] = {.framed = true};
  const Image framed = picture(scene_of(shown));
  EXPECT_TRUE(is_red(framed.pixel(110, 100)));
  // The outline passes over the upper face, along y: a line seen from above.
  const Image from_top = picture(scene_of(shown), from_above());
  EXPECT_FALSE(is_red(from_top.pixel(100, 100)));
  EXPECT_TRUE(is_red(from_top.pixel(94, 100)));
}

TEST_F(Volumes, HasteIsForWhatMovesAlone) {
  Renderer& renderer = *shared();
  Scene scene = scene_of(red_cube(30));
  const std::vector<Pane> panes = {level()};
  Image image;
  const auto draw = [&](Nanoseconds time) {
    ASSERT_TRUE(renderer.draw(scene, panes, kEdge, kEdge, image, false, time));
  };
  constexpr Nanoseconds kNoTime{1};
  draw(Nanoseconds{0});
  EXPECT_EQ(renderer.counters().volume_reduction, 1U);
  const Image full = image;
  for (int i = 0; i < 3; ++i) {
    scene.volumes[0].X_WV.translation().x() += 0.001;
    draw(kNoTime);
    EXPECT_GT(renderer.counters().volume_reduction, 1U);
    EXPECT_TRUE(renderer.counters().volume_in_haste);
    EXPECT_TRUE(is_red(image.pixel(100, 100)));
  }
  const std::uint64_t bricks = renderer.counters().volume_bricks_drawn;
  draw(kNoTime);  // stands still
  EXPECT_EQ(renderer.counters().volume_reduction, 1U);
  EXPECT_FALSE(renderer.counters().volume_in_haste);
  EXPECT_EQ(renderer.counters().volume_bricks_drawn, bricks);
  draw(kNoTime);  // nothing is cast again
  EXPECT_EQ(renderer.counters().volume_ns, 0U);
  EXPECT_EQ(count_different(image, full, {60, 60, 10, 80}), 0);
}

TEST_F(Volumes, WithoutAnyNothingIsCast) {
  static_cast<void>(picture(Scene{}));
  EXPECT_EQ(shared()->counters().volumes, 0U);
  EXPECT_EQ(shared()->counters().volume_ns, 0U);
}

TEST_F(Volumes, WhatCannotBeDrawnIsLeftOut) {
  Scene scene = scene_of(red_cube(200));
  scene.volumes[0].grid = nullptr;
  scene.volumes.push_back(red_cube(200));
  scene.volumes[1].X_WV.translation().x() = std::nan("");
  scene.volumes.push_back(red_cube(200));
  auto wrong = std::make_shared<VoxelGrid>(*cube());
  wrong->size[0] = 41;
  scene.volumes[2].grid = wrong;
  const Image sut = picture(scene);
  EXPECT_EQ(count_different(sut, picture(Scene{})), 0);
  EXPECT_EQ(objects(scene)[100 * kEdge + 100], 0U);
}

}  // namespace
}  // namespace cellmirror::display
