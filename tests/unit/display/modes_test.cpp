// Each mode and way of drawing changes the picture where it should, and nowhere else.
#include "rt_core/geometry/shape.hpp"
#include "tests/unit/display/renderer_fixture.hpp"

namespace cellmirror::display {
namespace {

class DisplayModes : public RendererTest {};

Scene box_scene() {
  Scene scene;
  add_box(scene, {1, 1, 1}, at(0, 0, 0)).rgba = {0.8F, 0.3F, 0.2F, 1};
  return scene;
}

TEST_F(DisplayModes, ABodyIsWhereItsObjectIs) {
  const Scene scene = box_scene();
  const std::vector<std::uint32_t> sut = objects(scene);
  const auto covered = std::count(sut.begin(), sut.end(), 1U);
  EXPECT_NEAR(static_cast<double>(covered), 2500, 110);  // 50 pixels a metre
  const Image with = picture(scene);
  const Image without = picture(Scene{});
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      const bool body = sut[static_cast<std::size_t>(y * kEdge + x)] == 1;
      ASSERT_EQ(body, differ(with.pixel(x, y), without.pixel(x, y))) << x << ' ' << y;
    }
  }
}

TEST_F(DisplayModes, TheNearerBodyHidesTheOther) {
  Scene scene = box_scene();
  add_box(scene, {0.5, 0.5, 0.5}, at(0, -2, 0));
  const std::vector<std::uint32_t> numbers = objects(scene);
  EXPECT_EQ(numbers[100 * kEdge + 100], 2U);
  EXPECT_EQ(numbers[100 * kEdge + 80], 1U);
  EXPECT_EQ(numbers[100 * kEdge + 20], 0U);
}

TEST_F(DisplayModes, UpIsUpAndRightIsRight) {
  Scene scene;
  add_box(scene, {0.2, 0.2, 0.2}, at(1, 0, 0));
  add_box(scene, {0.2, 0.2, 0.2}, at(0, 0, 1));
  const std::vector<std::uint32_t> numbers = objects(scene);
  EXPECT_EQ(numbers[100 * kEdge + 150], 1U);
  EXPECT_EQ(numbers[50 * kEdge + 100], 2U);
}

TEST_F(DisplayModes, WireframeShowsEdgesAndWhatIsBehindThem) {
  Scene scene = box_scene();
  scene.bodies[0].mode = DrawMode::wireframe;
  const Image sut = picture(scene);
  const Image without = picture(Scene{});
  EXPECT_EQ(count_different(sut, without, around(90, 100)), 0);  // a flat face has no diagonal
  EXPECT_GT(count_different(sut, without, {70, 70, 60, 60}), 150);
}

TEST_F(DisplayModes, FlatHasOneColourAFaceAndGouraudMany) {
  Scene scene;
  add_mesh(scene, torus(1.2, 0.5, 24, 12), at(0, 0, 0));
  const Region face{60, 100, 80, 8};
  scene.bodies[0].mode = DrawMode::flat;
  const std::size_t flat = distinct_colours(picture(scene), face);
  scene.bodies[0].mode = DrawMode::gouraud;
  const std::size_t gouraud = distinct_colours(picture(scene), face);
  EXPECT_GT(gouraud, 2 * flat);
}

TEST_F(DisplayModes, GouraudKeepsTheEdgesOfMachineParts) {
  Scene scene = box_scene();
  Pane pane = pane_looking_at({3, -4, 3}, {0, 0, 0}, 0.4);
  const Image sut = picture(scene, pane);
  EXPECT_LE(distinct_colours(sut, around(85, 120, 6)), 2U);  // each face has one colour, also near its edges
}

TEST_F(DisplayModes, WhatIsBehindATransparentBodyIsSeen) {
  Scene scene;
  add_box(scene, {2, 0.1, 2}, at(0, -1, 0)).mode = DrawMode::transparent;
  const Image alone = picture(scene);
  add_box(scene, {0.6, 0.6, 0.6}, at(0, 1, 0)).rgba = {0.1F, 0.1F, 0.6F, 1};
  const Image with = picture(scene);
  EXPECT_GT(mean_brightness(alone, around(100, 100)), mean_brightness(with, around(100, 100)) + 20);
  EXPECT_EQ(count_different(alone, with, around(60, 60)), 0);
  EXPECT_GT(count_different(alone, picture(Scene{}), around(60, 60)), 100);
}

TEST_F(DisplayModes, EitherBackfaceRemovalTakesAwayWhatFacesAway) {
  for (const DisplayMode mode : {DisplayMode::backface_removal, DisplayMode::cpu_backface_removal}) {
    for (const DrawMode draw : {DrawMode::gouraud, DrawMode::flat, DrawMode::wireframe, DrawMode::transparent}) {
      Scene scene;
      add_mesh(scene, sheet_facing_away(), at(0, 0, 0)).mode = draw;
      const Image empty = picture(Scene{});
      EXPECT_GT(count_different(picture(scene), empty), 300);
      set(scene, mode);
      EXPECT_EQ(count_different(picture(scene), empty), 0) << static_cast<int>(mode) << ' ' << static_cast<int>(draw);
      const std::vector<std::uint32_t> numbers = objects(scene);
      EXPECT_EQ(std::count(numbers.begin(), numbers.end(), 1U), 0);
    }
  }
}

TEST_F(DisplayModes, BackfaceRemovalLeavesClosedBodiesAlone) {
  Scene scene;
  add_mesh(scene, torus(1.2, 0.5, 24, 12), at(0, 0, 0));
  add_box(scene, {0.5, 0.7, 0.4}, at(0.2, -1, 0.3, 0.4));
  const Pane pane = pane_looking_at({3, -4, 3}, {0, 0, 0});
  const Image plain = picture(scene, pane);
  for (const DisplayMode mode : {DisplayMode::backface_removal, DisplayMode::cpu_backface_removal}) {
    Scene removed = scene;
    set(removed, mode);
    EXPECT_LE(count_different(plain, picture(removed, pane)), 20);
  }
}

TEST_F(DisplayModes, TwoSidedLightLightsTheInside) {
  Scene scene;
  auto sheet = std::make_shared<geometry::TriangleMesh>();  // shows its back to the light above
  sheet->vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  sheet->triangles = {{0, 2, 1}, {0, 3, 2}};
  add_mesh(scene, sheet, at(0, 0, 0));
  const double before = mean_brightness(picture(scene, from_above()), around(100, 100));
  set(scene, DisplayMode::two_sided_light);
  EXPECT_GT(mean_brightness(picture(scene, from_above()), around(100, 100)), before + 30);
}

TEST_F(DisplayModes, TheFloorIsBelowTheBodiesAndOnlyFromAbove) {
  Scene scene;
  scene.floor_z_m = -1;
  add_box(scene, {1, 1, 1}, at(0, 0, -0.5));
  const Image without = picture(scene, from_above());
  set(scene, DisplayMode::floor);
  const Image sut = picture(scene, from_above());
  EXPECT_GT(count_different(without, sut, around(40, 60)), 100);
  EXPECT_EQ(count_different(without, sut, around(100, 100, 20)), 0);  // the box
  const Pane from_below = parallel({0, 0, -10}, Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitY());
  Scene no_floor = scene;
  no_floor.modes.reset();
  EXPECT_EQ(count_different(picture(scene, from_below), picture(no_floor, from_below)), 0);
}

TEST_F(DisplayModes, AShadowFallsAwayFromTheLightAndOnlyOnTheFloor) {
  Scene scene;
  scene.floor_low = {-2, -2};
  scene.floor_high = {2, 2};
  add_box(scene, {0.6, 0.6, 0.6}, at(0, 0, 0.6));
  Scene shadow_alone = scene;
  set(shadow_alone, DisplayMode::shadows);
  EXPECT_EQ(count_different(picture(scene, from_above()), picture(shadow_alone, from_above())), 0);
  set(scene, DisplayMode::floor);
  const Image bright = picture(scene, from_above());
  set(scene, DisplayMode::shadows);
  const Image sut = picture(scene, from_above());
  // The light comes from -x, -y: the shadow lies to the right and above.
  EXPECT_LT(mean_brightness(sut, around(119, 78, 3)), mean_brightness(bright, around(119, 78, 3)) - 40);
  EXPECT_EQ(count_different(bright, sut, around(60, 140, 10)), 0);
  EXPECT_EQ(count_different(bright, sut, around(100, 100, 10)), 0);  // the box
}

TEST_F(DisplayModes, AShadowFallsOnASlabAsOnTheFloor) {
  Scene scene;
  scene.floor_z_m = -0.3;
  add_box(scene, {3, 3, 0.3}, at(0, 0, -0.15)).casts_shadow = false;
  add_box(scene, {0.6, 0.6, 0.6}, at(0, 0, 0.6));
  scene.shadow_catchers.push_back({0, {-1.5, -1.5}, {1.5, 1.5}});
  scene.shadow_catchers.push_back({std::nan(""), {-1, -1}, {1, 1}});
  set(scene, DisplayMode::floor);
  const Image bright = picture(scene, from_above());
  set(scene, DisplayMode::shadows);
  const Image sut = picture(scene, from_above());
  EXPECT_LT(mean_brightness(sut, around(119, 78, 3)), mean_brightness(bright, around(119, 78, 3)) - 30);
  EXPECT_EQ(count_different(bright, sut, around(60, 140, 10)), 0);
  EXPECT_EQ(count_different(bright, sut, around(100, 100, 10)), 0);  // the box
}

TEST_F(DisplayModes, TheEdgeOfAShadowIsSoft) {
  Scene scene;
  set(scene, DisplayMode::floor);
  set(scene, DisplayMode::shadows);
  add_box(scene, {1, 1, 0.1}, at(0, 0, 1));
  const Image sut = picture(scene, from_above());
  EXPECT_GT(distinct_colours(sut, {130, 76, 50, 1}), 8U);
}

TEST_F(DisplayModes, AGhostCastsNoShadow) {
  Scene scene;
  set(scene, DisplayMode::floor);
  add_box(scene, {0.6, 0.6, 0.6}, at(0, 0, 0.6)).mark = Mark::ghost;
  const Image bright = picture(scene, from_above());
  set(scene, DisplayMode::shadows);
  EXPECT_EQ(count_different(bright, picture(scene, from_above())), 0);
}

TEST_F(DisplayModes, TexturesAreOnTheFloor) {
  Scene scene;
  set(scene, DisplayMode::floor);
  add_box(scene, {1, 1, 1}, at(0, 0, 0.5));
  const Image plain = picture(scene, from_above());
  set(scene, DisplayMode::textures);
  const Image sut = picture(scene, from_above());
  const Region floor = around(58, 58, 7);
  EXPECT_GT(distinct_colours(sut, floor), distinct_colours(plain, floor) + 4);
  EXPECT_EQ(count_different(plain, sut, around(100, 100, 20)), 0);
}

TEST_F(DisplayModes, AntialiasingMixesColoursAtEdgesAlone) {
  Scene scene;
  add_box(scene, {1, 1, 1}, at(0, 0, 0)).rgba = {0.1F, 0.1F, 0.1F, 1};
  scene.bodies[0].X_WG.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Image hard = picture(scene);
  set(scene, DisplayMode::antialiasing);
  const Image sut = picture(scene);
  const int changed = count_different(hard, sut);
  EXPECT_GT(changed, 60);
  EXPECT_LT(changed, 500);
  EXPECT_EQ(count_different(hard, sut, around(100, 100, 15)), 0);
}

TEST_F(DisplayModes, TheVisibilityTestLeavesOutWhatIsBeside) {
  Scene scene = box_scene();
  add_box(scene, {1, 1, 1}, at(20, 0, 0));
  add_box(scene, {1, 1, 1}, at(0, -30, 0));  // behind the eye
  const Image plain = picture(scene);
  EXPECT_EQ(shared()->counters().bodies_left_out, 0U);
  set(scene, DisplayMode::visibility_test);
  EXPECT_EQ(count_different(plain, picture(scene)), 0);
  EXPECT_EQ(shared()->counters().bodies_left_out, 2U);
  EXPECT_EQ(shared()->counters().bodies_drawn, 1U);
}

TEST_F(DisplayModes, MarksAreToldApartByMoreThanTheirHue) {
  Scene scene = box_scene();
  scene.bodies[0].rgba = {0.72F, 0.72F, 0.74F, 1};
  const auto marked = [&](Mark mark) {
    scene.bodies[0].mark = mark;
    return picture(scene);
  };
  const Region face = around(100, 100, 18);
  const Image plain = marked(Mark::none);
  const Image near_by = marked(Mark::near);
  const Image touching = marked(Mark::touching);
  const Image ghost = marked(Mark::ghost);
  EXPECT_GT(near_by.pixel(100, 100)[0], near_by.pixel(100, 100)[2] + 60);            // amber
  EXPECT_GT(distinct_colours(touching, face), distinct_colours(near_by, face) + 1);  // stripes
  EXPECT_LT(mean_brightness(touching, face), mean_brightness(near_by, face) - 20);
  EXPECT_GT(mean_brightness(ghost, face), mean_brightness(plain, face));  // pale before a pale background
}

TEST_F(DisplayModes, AGhostLooksLikeOneThing) {
  Scene scene;
  add_box(scene, {1, 1, 1}, at(0, 0, 0)).mark = Mark::ghost;
  const Image one = picture(scene);
  add_box(scene, {0.5, 0.5, 0.5}, at(0, 0, 0)).mark = Mark::ghost;  // inside: not seen through
  EXPECT_EQ(count_different(one, picture(scene)), 0);
}

TEST_F(DisplayModes, ShapesHaveTheirSizes) {
  const auto covered = [](Shape shape, const Eigen::Vector3d& size, const Pane& pane) {
    Scene scene;
    SceneBody& body = add_box(scene, size, at(0, 0, 0));
    body.shape = shape;
    const std::vector<std::uint32_t> numbers = objects(scene, pane);
    return static_cast<double>(std::count(numbers.begin(), numbers.end(), 1U)) / 2500;  // m2
  };
  constexpr double kPi = std::numbers::pi;
  EXPECT_NEAR(covered(Shape::sphere, {0.8, 0, 0}, level()), kPi * 0.64, 0.04);
  EXPECT_NEAR(covered(Shape::cylinder, {0.5, 2, 0}, level()), 2, 0.08);
  EXPECT_NEAR(covered(Shape::cylinder, {0.5, 2, 0}, from_above()), kPi * 0.25, 0.03);
  EXPECT_NEAR(covered(Shape::capsule, {0.5, 1, 0}, level()), 1 + kPi * 0.25, 0.05);
  EXPECT_NEAR(covered(Shape::box, {0.5, 1, 2}, level()), 1, 0.06);
}

}  // namespace
}  // namespace cellmirror::display
