// Deforming surfaces: colours, wetness, uploads, draw modes, and what is left out.
#include <functional>

#include "drivers/display/internal/frame.hpp"
#include "drivers/display/internal/tissue/tissue_vertices.hpp"
#include "rt_core/ports/mesh_appearance.hpp"
#include "tests/unit/display/renderer_fixture.hpp"
#include "tests/unit/display/tissue_scenes.hpp"

namespace cellmirror::display {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class Tissue : public RendererTest {
 protected:
  static Scene scene_of(TissueSurface surface) {
    TissueView view;
    view.surfaces.push_back(std::move(surface));
    return with_tissue(std::move(view));
  }
  static Image drawn(TissueSurface surface, const Pane& pane = level()) {
    return picture(scene_of(std::move(surface)), pane);
  }
  // With its triangles changed.
  static TissueSurface sheet_with(const std::function<void(TissueTopology&)>& change) {
    TissueSurface surface = tissue_sheet();
    auto topology = std::make_shared<TissueTopology>(*surface.topology);
    change(*topology);
    surface.topology = topology;
    return surface;
  }
  // Level, 0.6 m x 0.6 m, at 0.6 m above the origin.
  static TissueSurface level_sheet() {
    TissueSurface surface = tissue_sheet();
    for (Eigen::Vector3f& p : surface.vertices) p = {0.3F * p.x(), 0.3F * p.z(), 0.6F};
    surface.normals.assign(surface.vertices.size(), Eigen::Vector3f::UnitZ());
    return surface;
  }
  static int reddish(const std::uint8_t* pixel) { return pixel[0] - (pixel[1] + pixel[2]) / 2; }
};

TEST_F(Tissue, ASurfaceIsWhereItsVerticesAre) {
  TissueSurface surface = tissue_sheet();
  const Image empty = picture(Scene{});
  EXPECT_NEAR(count_different(drawn(surface), empty), 10'000, 420);  // 50 pixels a metre
  for (Eigen::Vector3f& p : surface.vertices) p = 0.5F * p + Eigen::Vector3f(1, 0, 0);
  const Image moved = drawn(surface);
  EXPECT_EQ(count_different(moved, empty, {0, 0, 100, 200}), 0);
  EXPECT_NEAR(count_different(moved, empty), 2'500, 220);
}

TEST_F(Tissue, HeatMakesItBrownThenBlack) {
  TissueSurface surface = tissue_sheet();
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    if (surface.vertices[i].x() > -0.3F) surface.burn[i] = 1;
    if (surface.vertices[i].x() > 0.3F) surface.burn[i] = 2;
  }
  const Image sut = drawn(surface);
  const std::uint8_t* const raw = sut.pixel(60, 100);
  const std::uint8_t* const coagulated = sut.pixel(100, 100);
  const std::uint8_t* const charred = sut.pixel(140, 100);
  EXPECT_LT(std::abs(reddish(raw)), 8);
  EXPECT_GT(reddish(coagulated), 20);
  EXPECT_LT(brightness(coagulated), brightness(raw) - 30);
  EXPECT_LT(brightness(charred), brightness(coagulated) - 30);
  EXPECT_LT(brightness(charred), 40);
}

TEST_F(Tissue, FacesOfACutAreRawFlesh) {
  const Image sut = drawn(sheet_with([](TissueTopology& topology) {
    for (std::size_t i = 0; i < topology.triangles.size() / 2; ++i) topology.cut_face[i] = 1;  // the lower half
  }));
  EXPECT_LT(std::abs(reddish(sut.pixel(100, 75))), 8);
  EXPECT_GT(reddish(sut.pixel(100, 125)), 60);
  EXPECT_LT(brightness(sut.pixel(100, 125)), brightness(sut.pixel(100, 75)) - 30);
}

TEST_F(Tissue, AWetOneShinesInTheMirrorDirection) {
  const Eigen::Vector3d to_eye = -Eigen::Vector3d::UnitY();
  const Eigen::Vector3f mirror = (towards_light() + to_eye).normalized().cast<float>();
  const auto brightness_of = [&](bool wet, const Eigen::Vector3f& normal, float burn) {
    TissueSurface surface = tissue_sheet();
    surface.wet = wet;
    surface.normals.assign(surface.vertices.size(), normal);
    surface.burn.assign(surface.vertices.size(), burn);
    return mean_brightness(drawn(surface), around(100, 100));
  };
  EXPECT_GT(brightness_of(true, mirror, 0), brightness_of(false, mirror, 0) + 50);
  const Eigen::Vector3f elsewhere = Eigen::Vector3f(0.6F, -0.8F, 0);
  EXPECT_NEAR(brightness_of(true, elsewhere, 0), brightness_of(false, elsewhere, 0), 12);
  EXPECT_NEAR(brightness_of(true, mirror, 1), brightness_of(false, mirror, 1), 25) << "a crust is dry";
}

TEST_F(Tissue, ATextureLiesOnTheSkinAloneAndTheModeSwitchesIt) {
  auto green = std::make_shared<Image>();
  green->width = green->height = 2;
  for (int i = 0; i < 4; ++i) green->rgba.insert(green->rgba.end(), {20, 200, 20, 255});
  auto look = std::make_shared<MeshAppearance>();
  look->palette = {{nullptr, {0, 0, 1}}, {green, {1, 1, 1}}};
  TissueSurface surface = sheet_with([](TissueTopology& topology) {
    for (std::size_t i = 0; i < topology.triangles.size() / 2; ++i) topology.cut_face[i] = 1;
  });
  surface.look = look;
  Scene scene = scene_of(surface);
  const auto greenish = [](const Image& image, int y) { return image.pixel(100, y)[1] - image.pixel(100, y)[0]; };
  EXPECT_LT(greenish(picture(scene), 75), 20);
  set(scene, DisplayMode::textures);
  EXPECT_GT(greenish(picture(scene), 75), 60);
  EXPECT_LT(greenish(picture(scene), 125), 0);
}

TEST_F(Tissue, TrianglesAreUploadedWhenTheyChangeAlone) {
  TissueSurface surface = tissue_sheet();
  const std::uint64_t before = shared()->counters().tissue_uploads;
  for (int i = 0; i < 3; ++i) {
    surface.vertices[0].x() -= 0.1F;
    drawn(surface);
  }
  EXPECT_EQ(shared()->counters().tissue_uploads, before + 1);
  surface.topology = std::make_shared<TissueTopology>(*surface.topology);
  drawn(surface);
  EXPECT_EQ(shared()->counters().tissue_uploads, before + 2);
}

TEST_F(Tissue, TheNearerHidesTheOther) {
  Scene scene = scene_of(tissue_sheet());
  const Image alone = picture(scene);
  add_box(scene, {0.4, 0.4, 0.4}, at(0, 2, 0));
  EXPECT_EQ(count_different(alone, picture(scene)), 0);
  add_box(scene, {0.4, 0.4, 0.4}, at(0, -2, 0));
  EXPECT_NEAR(count_different(alone, picture(scene)), 400, 60);
}

TEST_F(Tissue, ItThrowsAShadowAsItMoves) {
  Scene scene = scene_of(level_sheet());
  scene.floor_low = {-2, -2};
  scene.floor_high = {2, 2};
  set(scene, DisplayMode::floor);
  const Image bright = picture(scene, from_above());
  set(scene, DisplayMode::shadows);
  EXPECT_LT(mean_brightness(picture(scene, from_above()), around(119, 78, 3)),
            mean_brightness(bright, around(119, 78, 3)) - 40);
  TissueView away = *scene.tissue;
  for (Eigen::Vector3f& p : away.surfaces[0].vertices) p.x() += 1;
  scene.tissue = std::make_shared<const TissueView>(std::move(away));
  EXPECT_NEAR(mean_brightness(picture(scene, from_above()), around(119, 78, 3)),
              mean_brightness(bright, around(119, 78, 3)), 12);
}

TEST_F(Tissue, ItIsDrawnInEachMode) {
  Scene scene;
  TissueView view;
  view.surfaces.push_back(organ(organ_topology(24, 12), 24, 12, 0.9, 0));
  view.surfaces[0].wet = false;
  scene = with_tissue(view);
  const Image empty = picture(Scene{});
  const Image gouraud = picture(scene);
  scene.tissue_modes = {DrawMode::flat};
  const Image flat = picture(scene);
  const Region face{75, 85, 50, 30};
  EXPECT_GT(distinct_colours(gouraud, face), 2 * distinct_colours(flat, face));
  scene.tissue_modes = {DrawMode::wireframe};
  const Image wires = picture(scene);
  EXPECT_GT(count_different(wires, empty), 400);
  EXPECT_LT(count_different(wires, empty), count_different(gouraud, empty) * 3 / 4);
  scene.tissue_modes = {DrawMode::transparent};
  const Image before = picture(scene);
  add_box(scene, {0.4, 0.4, 0.4}, at(0, 3, 0)).rgba = {0, 0, 0.3F, 1};
  EXPECT_GT(mean_brightness(before, around(100, 100)), mean_brightness(picture(scene), around(100, 100)) + 20);
}

TEST_F(Tissue, BackFacesAreLitButRemovedWhereAsked) {
  Scene scene = scene_of(tissue_sheet());
  const Pane behind = parallel({0, 10, 0}, -Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ());
  EXPECT_GT(mean_brightness(picture(scene, behind), around(100, 100)), 60);
  set(scene, DisplayMode::backface_removal);
  EXPECT_EQ(count_different(picture(scene, behind), picture(Scene{}, behind)), 0);
  EXPECT_GT(count_different(picture(scene), picture(Scene{})), 9'000);
}

TEST_F(Tissue, BackFacesOfAClosedOneAreLeftOutUnseen) {
  TissueSurface surface = organ(organ_topology(24, 12), 24, 12, 0.9, 0);
  const Image closed = drawn(surface);
  auto open = std::make_shared<TissueTopology>(*surface.topology);
  std::erase_if(open->triangles, [&](const auto& t) { return surface.vertices[t[0]].y() > 0.6F; });  // behind
  ASSERT_LT(open->triangles.size(), surface.topology->triangles.size());
  open->cut_face.clear();
  surface.topology = open;
  EXPECT_LE(count_different(drawn(surface), closed), 20);
}

TEST_F(Tissue, TheInsideIsSeenByWhoIsInside) {
  const TissueSurface surface = organ(organ_topology(24, 12), 24, 12, 0.9, 0);
  Pane pane = pane_looking_at({0, -0.2, 0}, {0, 1, 0}, 1.0);
  EXPECT_EQ(count_different(drawn(surface, pane), picture(Scene{}, pane)), kEdge * kEdge);
  pane = level();
  pane.eye.near_distance = 10;  // cut open
  EXPECT_GT(mean_brightness(picture(Scene{}, pane), around(100, 100)),
            mean_brightness(drawn(surface, pane), around(100, 100)) + 40);
}

TEST(TissueTriangles, AreClosedWhereEachEdgeHasTwoSides) {
  EXPECT_TRUE(is_closed(*divide_by_cut(*organ_topology(9, 5))));
  EXPECT_FALSE(is_closed(*divide_by_cut(*tissue_sheet().topology)));
  TissueTopology sut = *organ_topology(9, 5);
  std::swap(sut.triangles[3][0], sut.triangles[3][1]);
  EXPECT_FALSE(is_closed(*divide_by_cut(sut)));
  sut.triangles.erase(sut.triangles.begin() + 3);
  EXPECT_FALSE(is_closed(*divide_by_cut(sut)));
}

TEST(TissueTriangles, HaveEachEdgeOnce) {
  TissueTopology sut;
  sut.triangles = {{0, 1, 2}, {2, 1, 3}};
  EXPECT_EQ(edges_of(*divide_by_cut(sut)), (std::vector<Corner>{0, 1, 0, 2, 1, 2, 1, 3, 2, 3}));
  EXPECT_FALSE(divide_by_cut(TissueTopology{}));
}

TEST_F(Tissue, AnInvisibleOneIsNotDrawn) {
  TissueSurface surface = tissue_sheet();
  surface.visible = false;
  EXPECT_EQ(count_different(drawn(surface), picture(Scene{})), 0);
}

TEST_F(Tissue, AFarPlaneBeforeItAndAVisibilityTestHideNothing) {
  Scene scene = scene_of(tissue_sheet());
  Pane pane = level();
  pane.eye.far_distance = 1e6;
  set(scene, DisplayMode::visibility_test);
  EXPECT_EQ(count_different(picture(scene, pane), picture(scene)), 0);
}

TEST_F(Tissue, PicksSeeThroughIt) {
  Scene scene = scene_of(tissue_sheet());
  add_box(scene, {0.4, 0.4, 0.4}, at(0, 2, 0));
  EXPECT_EQ(objects(scene)[100 * kEdge + 100], 1U);
}

TEST_F(Tissue, SurfacesThatMakeNoSenseAreLeftOut) {
  const Image empty = picture(Scene{});
  const std::vector<std::function<void(TissueSurface&)>> changes = {
      [](TissueSurface& s) { s.topology = nullptr; },
      [](TissueSurface& s) { s.topology = std::make_shared<const TissueTopology>(); },
      [](TissueSurface& s) { s.vertices.clear(); },
      [](TissueSurface& s) { s.vertices.pop_back(); },
      [](TissueSurface& s) {
        s.vertices.pop_back();
        s.normals.pop_back();  // an index is out of range
      },
      [](TissueSurface& s) { s.normals.clear(); },
      [](TissueSurface& s) { s.vertices[3].y() = kNan; },
      [](TissueSurface& s) { s.vertices[3].z() = std::numeric_limits<float>::infinity(); },
      [](TissueSurface& s) { s.vertices[3].x() = 1e30F; },
      [](TissueSurface& s) {
        auto topology = std::make_shared<TissueTopology>(*s.topology);
        topology->triangles[5] = {0, 1, 0xFFFF'FFFFU};
        s.topology = topology;
      }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    TissueSurface surface = tissue_sheet();
    changes[i](surface);
    Scene scene = scene_of(surface);
    set(scene, DisplayMode::visibility_test);
    EXPECT_EQ(count_different(picture(scene), empty), 0) << i;
    scene.tissue_modes = {DrawMode::wireframe};
    EXPECT_EQ(count_different(picture(scene), empty), 0) << i;
  }
}

TEST_F(Tissue, VerticesThatNoTriangleUsesDoNotCount) {
  TissueSurface surface = tissue_sheet();
  const Scene plain = scene_of(surface);
  auto topology = std::make_shared<TissueTopology>(*surface.topology);
  topology->rgb.resize(surface.vertices.size() + 3, {1, 1, 1});
  topology->texture.resize(surface.vertices.size() + 3, Eigen::Vector2f::Zero());
  surface.topology = topology;
  for (const float bad : {kNan, 1e30F, 5e4F}) {
    surface.vertices.emplace_back(bad, 0.0F, 0.0F);
    surface.normals.emplace_back(0.0F, -1.0F, 0.0F);
    surface.burn.push_back(0);
  }
  Scene scene = scene_of(surface);
  EXPECT_EQ(count_different(picture(scene), picture(plain)), 0);
  Pane pane = level();
  pane.eye.height_m = 0;
  pane.eye.near_distance = 0;
  pane.eye.far_distance = 1e6;
  EXPECT_EQ(count_different(picture(scene, pane), picture(plain, pane)), 0) << "the depths are divided as before";
}

TEST_F(Tissue, AttributesOfOtherSizesAreAsIfAbsent) {
  const auto flesh = [](TissueTopology& topology) { topology.rgb.clear(); };
  const Image plain = drawn(sheet_with(flesh));
  EXPECT_GT(reddish(plain.pixel(100, 100)), 20);
  EXPECT_EQ(count_different(plain, drawn(sheet_with([](TissueTopology& t) { t.rgb.resize(3); }))), 0);
  EXPECT_EQ(count_different(plain, drawn(sheet_with([&](TissueTopology& t) {
                              flesh(t);
                              t.cut_face.assign(3, 1);
                              t.texture.resize(2);
                            }))),
            0);
  TissueSurface surface = sheet_with(flesh);
  surface.burn.assign(3, 2);
  EXPECT_EQ(count_different(plain, drawn(surface)), 0);
  surface.burn.assign(surface.vertices.size(), kNan);
  EXPECT_EQ(count_different(plain, drawn(surface)), 0);
}

TEST_F(Tissue, ColoursAndNormalsThatAreNotFiniteDoNoHarm) {
  TissueSurface surface = sheet_with([](TissueTopology& topology) {
    topology.rgb.assign(topology.rgb.size(), {kNan, 1e30F, -5});
    topology.texture.assign(topology.texture.size(), {kNan, 1e30F});
  });
  surface.normals.assign(surface.normals.size(), {kNan, kNan, kNan});
  surface.burn.assign(surface.burn.size(), 1e30F);
  EXPECT_NEAR(count_different(drawn(surface), picture(Scene{})), 10'000, 420);
  surface.normals.assign(surface.normals.size(), Eigen::Vector3f::Zero());
  drawn(surface);
}

TEST_F(Tissue, ManySurfacesAndEmptyViewsInTurns) {
  TissueView many;
  for (int i = 0; i < 200; ++i) many.surfaces.push_back(tissue_sheet(2));
  const Image sut = picture(with_tissue(many));
  EXPECT_EQ(count_different(picture(with_tissue({})), picture(Scene{})), 0);
  EXPECT_EQ(count_different(picture(with_tissue(many)), sut), 0);
}

}  // namespace
}  // namespace cellmirror::display
