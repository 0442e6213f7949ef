// What the renderer keeps, refuses and survives, on each backend.
#include "rt_core/geometry/shape.hpp"
#include "tests/unit/display/renderer_fixture.hpp"

namespace cellmirror::display {
namespace {

class DisplayRenderer : public RendererTest {};

TEST_F(DisplayRenderer, SaysWhatDraws) {
  const std::string_view sut = shared()->name();
  EXPECT_TRUE(sut.starts_with("OSMesa: ") || sut.starts_with("EGL: ")) << sut;
  EXPECT_NE(sut.find(", OpenGL "), std::string_view::npos) << sut;
}

TEST_F(DisplayRenderer, BothBackendsDrawTheSameInTurns) {
  const auto osmesa = Renderer::create({.backend = Backend::osmesa});
  if (!osmesa) GTEST_SKIP() << "skipped: " << osmesa.error().text();
  const auto egl = Renderer::create({.backend = Backend::egl});
  if (!egl) GTEST_SKIP() << "skipped: " << egl.error().text();
  EXPECT_TRUE((*osmesa)->name().starts_with("OSMesa: "));
  EXPECT_TRUE((*egl)->name().starts_with("EGL: "));
  const Scene scene = gallery_scene();
  const std::vector<Pane> panes = {gallery_pane()};
  Image first;
  Image second;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE((*osmesa)->draw(scene, panes, 320, 180, first));
    ASSERT_TRUE((*egl)->draw(scene, panes, 320, 180, second));
    EXPECT_LE(count_different(first, second), 320 * 180 / 100);
  }
}

TEST_F(DisplayRenderer, UploadsAMeshOnceAndForgetsItWhenNobodyHoldsIt) {
  const auto sut = Renderer::create();
  ASSERT_TRUE(sut);
  Image image;
  {
    Scene scene;
    const auto mesh = torus(1, 0.3, 24, 12);
    add_mesh(scene, mesh, at(0, 0, 0));
    add_mesh(scene, mesh, at(1, 0, 0));
    for (int i = 0; i < 3; ++i) ASSERT_TRUE((*sut)->draw(scene, std::vector<Pane>{level()}, 64, 64, image));
    EXPECT_EQ((*sut)->counters().uploads, 1U);
    EXPECT_EQ((*sut)->counters().meshes, 1U);
    EXPECT_EQ((*sut)->counters().frames, 3U);
  }
  ASSERT_TRUE((*sut)->draw(Scene{}, std::vector<Pane>{level()}, 64, 64, image));
  EXPECT_EQ((*sut)->counters().meshes, 0U);
}

TEST_F(DisplayRenderer, RefusesSizesThatMakeNoSense) {
  Image image;
  std::vector<std::uint32_t> numbers;
  const std::vector<Pane> panes = {level()};
  for (const auto& [width, height] : {std::pair(15, 100), {100, 15}, {4097, 100}, {100, 4097}, {0, 0}, {-5, 100}}) {
    const Result<void> drawn = shared()->draw(Scene{}, panes, width, height, image);
    ASSERT_FALSE(drawn);
    EXPECT_NE(drawn.error().text().find("16 to 4096"), std::string::npos) << drawn.error().text();
    EXPECT_FALSE(shared()->objects(Scene{}, panes, width, height, numbers));
  }
  EXPECT_TRUE(shared()->draw(Scene{}, panes, 16, 16, image));
  EXPECT_TRUE(shared()->draw(Scene{}, panes, 4096, 16, image));
  EXPECT_EQ(image.rgba.size(), std::size_t{4} * 4096 * 16);
}

TEST_F(DisplayRenderer, PicturesAreOpaque) {
  Scene scene = gallery_scene();
  const Image sut = picture(scene, gallery_pane());
  for (std::size_t i = 3; i < sut.rgba.size(); i += 4) ASSERT_EQ(sut.rgba[i], 255) << i;
}

TEST_F(DisplayRenderer, ObjectNumbersHave32Bits) {
  Scene scene;
  add_box(scene, {1, 1, 1}, at(0, 0, 0)).object = 0xFEDCBA98U;
  EXPECT_EQ(objects(scene)[100 * kEdge + 100], 0xFEDCBA98U);
}

TEST_F(DisplayRenderer, WhatHasNoNumberHidesNothingFromAPick) {
  Scene scene;
  add_box(scene, {1, 1, 1}, at(0, 0, 0));
  add_box(scene, {1, 1, 1}, at(0, -2, 0)).object = 0;
  EXPECT_EQ(objects(scene)[100 * kEdge + 100], 1U);
}

// Adds one of each thing that no picture should be changed by.
void add_nonsense(Scene& scene) {
  const double nan = std::nan("");
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinite, -infinite, 1e300}) {
    Pose X = Pose::Identity();
    X.translation().x() = bad;
    SceneBody& placed = add_box(scene, {1, 1, 1}, X);
    placed.mark = Mark::touching;
    add_box(scene, {bad, 1, 1}, Pose::Identity());
    for (const Shape shape : {Shape::cylinder, Shape::sphere, Shape::capsule})
      add_box(scene, {bad, bad, bad}, Pose::Identity()).shape = shape;
    scene.axes.push_back({X, 1, false, "nonsense"});
    scene.lines.push_back({{bad, 0, 0}, {0, 0, 0}});
    scene.traces.push_back({{{static_cast<float>(bad), 0, 0}, {static_cast<float>(bad), 1, 0}}, {}});
    SceneCone& cone = scene.cones.emplace_back();
    cone.half_angle_rad = 0.3;
    cone.length_m = bad;
    scene.arrows.push_back({{0, 0, 0}, {bad, 0, 0}});
    scene.sparks.push_back({{bad, 0, 0}, 1});
    scene.labels.push_back({{0, bad, 0}, "nonsense"});
  }
  for (const double size : {0.0, -1.0}) add_box(scene, {size, 1, 1}, Pose::Identity());
  add_mesh(scene, nullptr, Pose::Identity());
  add_mesh(scene, std::make_shared<geometry::TriangleMesh>(), Pose::Identity());
  auto broken = std::make_shared<geometry::TriangleMesh>();
  broken->vertices = {{0, 0, 0}, {1, 0, 0}};
  broken->triangles = {{0, 1, 7}};
  add_mesh(scene, broken, Pose::Identity());
}

TEST_F(DisplayRenderer, NonsenseIsLeftOut) {
  Scene scene;
  add_box(scene, {0.5, 0.5, 0.5}, at(0.3, 0, 0.2));
  set(scene, DisplayMode::floor);
  set(scene, DisplayMode::shadows);
  const Image before = picture(scene);
  add_nonsense(scene);
  EXPECT_EQ(count_different(before, picture(scene)), 0);
  for (const DisplayMode mode :
       {DisplayMode::cpu_backface_removal, DisplayMode::visibility_test, DisplayMode::textures})
    set(scene, mode);
  for (SceneBody& body : scene.bodies) body.mode = DrawMode::wireframe;
  picture(scene);
}

TEST_F(DisplayRenderer, AFarPlaneFarBeyondTheSceneHidesNothing) {
  Scene scene;
  add_box(scene, {0.4, 0.4, 0.4}, at(0, -9, 0));  // 1 m before the eye
  Pane pane = level();
  pane.eye.near_distance = 0.2;
  pane.eye.far_distance = 1e6;
  EXPECT_EQ(objects(scene, pane)[100 * kEdge + 100], 1U) << "parallel";
  pane.eye.height_m = 0;
  EXPECT_EQ(objects(scene, pane)[100 * kEdge + 100], 1U);
  add_box(scene, {10, 10, 10}, at(0, 9e4, 0));  // a stray one
  EXPECT_EQ(objects(scene, pane)[100 * kEdge + 100], 1U);
  EXPECT_EQ(objects(scene, pane)[10 * kEdge + 100], 0U);
}

TEST_F(DisplayRenderer, ANearPlaneInTheEyeLeavesDepthsApart) {
  Scene scene;
  add_box(scene, {2, 1, 2}, at(0, 0.5, 0));
  add_box(scene, {1, 1, 1}, at(0, 0.49, 0));  // 10 mm before the other
  Pane pane = level();
  pane.eye.height_m = 0;
  pane.eye.opening_angle = 0.1;
  pane.eye.near_distance = 0;
  pane.eye.far_distance = 60;
  pane.eye.X_WE.linear() =
      Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitZ()).toRotationMatrix() * pane.eye.X_WE.linear();
  const auto sut = objects(scene, pane);
  int others = 0;
  int seen = 0;
  for (std::size_t i = 0; i < sut.size(); ++i) {
    const int x = static_cast<int>(i) % kEdge;
    const int y = static_cast<int>(i) / kEdge;
    if (x < 80 || x > 120 || y < 80 || y > 120) continue;
    (sut[i] == 2U ? seen : others) += 1;
  }
  EXPECT_EQ(others, 0);
  EXPECT_EQ(seen, 41 * 41);
}

TEST_F(DisplayRenderer, HostileEyesAndPanesDoNoHarm) {
  Scene scene = gallery_scene();
  const double nan = std::nan("");
  std::vector<Pane> panes(7, gallery_pane());
  panes[0].eye.X_WE.translation().x() = nan;
  panes[1].eye.opening_angle = nan;
  panes[2].eye.near_distance = -1;
  panes[2].eye.far_distance = nan;
  panes[3].eye.height_m = 1e300;
  panes[4].left = nan;
  panes[5].width = 1e9;
  panes[6].left = 2;
  Image image;
  for (const Pane& pane : panes) EXPECT_TRUE(shared()->draw(scene, std::vector<Pane>{pane}, 64, 64, image));
  EXPECT_TRUE(shared()->draw(scene, std::vector<Pane>(1000, gallery_pane()), 64, 64, image));
  EXPECT_TRUE(shared()->draw(Scene{}, {}, 64, 64, image));
  EXPECT_GT(brightness(image.pixel(60, 60)), 150);  // background
  scene.floor_low = {nan, -1e300};
  scene.floor_high = {1e300, nan};
  scene.floor_z_m = nan;
  EXPECT_TRUE(shared()->draw(scene, std::vector<Pane>{gallery_pane()}, 64, 64, image));
}

TEST_F(DisplayRenderer, ThousandsOfThingsAreBounded) {
  Scene scene;
  for (int i = 0; i < 20000; ++i) {
    const double x = i % 200 * 0.02 - 2;
    scene.labels.push_back({{x, 0, i / 200 * 0.02 - 1}, "label " + std::to_string(i), Mark::none});
    scene.lines.push_back({{x, 0, 0}, {x, 0, 1}});
  }
  scene.messages.assign(1000, std::string(100000, 'x'));
  scene.legend.assign(1000, {{1, 0, 0, 1}, std::string(10000, '\xFF')});
  scene.labels.push_back({{0, 0, 0}, std::string("\x01\xC0\x80\xED\xA0\x80\xF4\x90\x80\x80 broken"), Mark::touching});
  picture(scene);
}

TEST_F(DisplayRenderer, ChangingModesAndSizesFromFrameToFrameWorks) {
  Scene scene = gallery_scene();
  Image image;
  std::vector<std::uint32_t> numbers;
  const std::vector<Pane> panes = {gallery_pane()};
  for (int i = 0; i < 12; ++i) {
    scene.modes.flip(static_cast<std::size_t>(DisplayMode::antialiasing));
    if (i % 3 == 0) scene.modes.flip(static_cast<std::size_t>(DisplayMode::textures));
    ASSERT_TRUE(shared()->draw(scene, panes, 64 + 16 * (i % 4), 64, image));
    ASSERT_TRUE(shared()->objects(scene, panes, 64, 64 + 8 * (i % 2), numbers));
  }
}

}  // namespace
}  // namespace cellmirror::display
