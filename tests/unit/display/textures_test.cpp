// Pictures and colours on meshes, and what TEXTURES switches.
#include "rt_core/geometry/shape.hpp"
#include "rt_core/ports/mesh_appearance.hpp"
#include "tests/unit/display/renderer_fixture.hpp"

namespace cellmirror::display {
namespace {

using Rgba = std::array<std::uint8_t, 4>;

class Textures : public RendererTest {
 protected:
  // A sheet of 2 m x 2 m that shows its front to who looks along +y; 100 pixels each way in the middle.
  static std::shared_ptr<const geometry::TriangleMesh> sheet() {
    auto mesh = std::make_shared<geometry::TriangleMesh>();
    mesh->vertices = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
    mesh->triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
  }

  static std::shared_ptr<Image> quarters(const Rgba& upper_left, const Rgba& upper_right, const Rgba& lower_left,
                                         const Rgba& lower_right) {
    constexpr int kSize = 32;
    auto image = std::make_shared<Image>();
    image->width = image->height = kSize;
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const Rgba& left = y < kSize / 2 ? upper_left : lower_left;
        const Rgba& right = y < kSize / 2 ? upper_right : lower_right;
        for (const std::uint8_t part : x < kSize / 2 ? left : right) image->rgba.push_back(part);
      }
    }
    return image;
  }
  static std::shared_ptr<Image> red_green_blue_white() {
    return quarters({220, 20, 20, 255}, {20, 220, 20, 255}, {20, 20, 220, 255}, {230, 230, 230, 255});
  }

  // The picture once over the sheet, upright.
  static MeshAppearance look_of(std::shared_ptr<const Image> image) {
    MeshAppearance look;
    look.places = {{0, 1}, {1, 1}, {1, 0}, {0, 1}, {1, 0}, {0, 0}};
    look.materials = {0, 0};
    look.palette = {{std::move(image), {1, 1, 1}}};
    return look;
  }
  static std::shared_ptr<const MeshAppearance> shared_look(MeshAppearance look) {
    return std::make_shared<const MeshAppearance>(std::move(look));
  }

  static Scene textured(std::shared_ptr<const MeshAppearance> look) {
    Scene scene;
    add_mesh(scene, sheet(), at(0, 0, 0)).look = std::move(look);
    set(scene, DisplayMode::textures);
    return scene;
  }
  static Scene textured() { return textured(shared_look(look_of(red_green_blue_white()))); }

  // The strongest of red (0), green (1) and blue (2); 3 where none stands out.
  static int hue(const Image& image, int x, int y) {
    const std::uint8_t* const p = image.pixel(x, y);
    for (int i = 0; i < 3; ++i) {
      if (p[i] > p[(i + 1) % 3] + 40 && p[i] > p[(i + 2) % 3] + 40) return i;
    }
    return 3;
  }
};

TEST_F(Textures, APictureLiesUprightOnItsMesh) {
  const Image sut = picture(textured());
  EXPECT_EQ(hue(sut, 75, 75), 0);
  EXPECT_EQ(hue(sut, 125, 75), 1);
  EXPECT_EQ(hue(sut, 75, 125), 2);
  EXPECT_EQ(hue(sut, 125, 125), 3);
  EXPECT_GT(brightness(sut.pixel(125, 125)), 100);
}

TEST_F(Textures, TheModeSwitchesThemAndNothingElse) {
  Scene scene = textured();
  const Image on = picture(scene);
  scene.modes.reset();
  const Image off = picture(scene);
  EXPECT_GT(count_different(on, off, {55, 55, 90, 90}), 8000);
  EXPECT_EQ(count_different(on, off, {0, 0, 200, 45}), 0);
  scene.bodies[0].look = nullptr;
  const Image without = picture(scene);
  EXPECT_EQ(count_different(off, without), 0);
  set(scene, DisplayMode::textures);
  EXPECT_EQ(count_different(picture(scene), without), 0);
}

TEST_F(Textures, EveryWayOfDrawingButWireframeShowsThem) {
  for (const DrawMode mode : {DrawMode::flat, DrawMode::gouraud, DrawMode::transparent}) {
    for (const bool computed : {false, true}) {
      Scene scene = textured();
      if (computed) set(scene, DisplayMode::cpu_backface_removal);
      scene.bodies[0].mode = mode;
      const Image sut = picture(scene);
      EXPECT_GT(sut.pixel(75, 75)[0], sut.pixel(75, 75)[2] + 40) << static_cast<int>(mode);
      EXPECT_GT(sut.pixel(75, 125)[2], sut.pixel(75, 125)[0] + 40) << static_cast<int>(mode);
    }
  }
  Scene scene = textured();
  scene.bodies[0].mode = DrawMode::wireframe;
  const Image wires = picture(scene);
  scene.bodies[0].look = nullptr;
  EXPECT_EQ(count_different(wires, picture(scene)), 0);
}

TEST_F(Textures, TheBackIsShadedAsWithout) {
  Scene scene = textured();
  const Pane from_behind = parallel({0, 10, 0}, -Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ());
  set(scene, DisplayMode::two_sided_light);
  EXPECT_EQ(hue(picture(scene, from_behind), 125, 75), 0);  // what is left from the front is right from behind
  set(scene, DisplayMode::backface_removal);
  EXPECT_EQ(count_different(picture(scene, from_behind), picture(Scene{}, from_behind)), 0);
}

TEST_F(Textures, MarksAreSeenOnThem) {
  Scene scene = textured();
  const auto marked = [&](Mark mark) {
    scene.bodies[0].mark = mark;
    return picture(scene);
  };
  const Image plain = marked(Mark::none);
  const Image near_by = marked(Mark::near);
  const Image touching = marked(Mark::touching);
  const Image ghost = marked(Mark::ghost);
  EXPECT_GT(near_by.pixel(75, 125)[0], near_by.pixel(75, 125)[2] + 40);  // amber on blue
  EXPECT_GT(distinct_colours(touching, around(125, 125, 18)), distinct_colours(near_by, around(125, 125, 18)) + 1);
  EXPECT_LT(mean_brightness(touching, around(125, 125, 18)), mean_brightness(near_by, around(125, 125, 18)) - 20);
  EXPECT_GT(brightness(ghost.pixel(75, 125)), brightness(plain.pixel(75, 125)) + 40);
}

TEST_F(Textures, TheOwnColourShowsWhereAPictureIsSeeThrough) {
  constexpr Rgba kNothing{0, 0, 0, 0};
  Scene scene = textured(shared_look(look_of(quarters({220, 20, 20, 255}, kNothing, kNothing, kNothing))));
  scene.bodies[0].rgba = {0.1F, 0.8F, 0.1F, 1};
  const Image sut = picture(scene);
  EXPECT_EQ(hue(sut, 75, 75), 0);
  EXPECT_EQ(hue(sut, 125, 75), 1);
  scene.modes.reset();
  EXPECT_EQ(count_different(sut, picture(scene), {105, 105, 40, 40}), 0);
}

TEST_F(Textures, EachTriangleHasItsMaterialAndEachCornerItsColour) {
  MeshAppearance look = look_of(red_green_blue_white());
  look.palette = {{nullptr, {0.9F, 0.1F, 0.1F}}, {nullptr, {1, 1, 1}}};
  look.materials = {1, 0};
  look.colours.assign(6, {30, 30, 230, 255});
  std::fill(look.colours.begin() + 3, look.colours.end(), Rgba{255, 255, 255, 255});
  const Image sut = picture(textured(shared_look(look)));
  EXPECT_EQ(hue(sut, 130, 120), 2);  // below the diagonal: the second material, blue corners
  EXPECT_EQ(hue(sut, 70, 80), 0);
}

TEST_F(Textures, APictureIsUploadedOnceAndOnlyWhenItIsSeen) {
  const auto image = red_green_blue_white();
  const auto before = shared()->counters();
  {
    Scene scene;
    for (const double x : {-1.0, 1.0}) add_mesh(scene, sheet(), at(x, 0, 0)).look = shared_look(look_of(image));
    picture(scene);
    EXPECT_EQ(shared()->counters().texture_uploads, before.texture_uploads);
    set(scene, DisplayMode::textures);
    picture(scene);
    picture(scene);
    EXPECT_EQ(shared()->counters().texture_uploads, before.texture_uploads + 1);
    EXPECT_GE(shared()->counters().texture_bytes, std::size_t{32 * 32 * 4});
    EXPECT_EQ(shared()->counters().uploads, before.uploads + 2);
  }
  picture(Scene{});
  EXPECT_EQ(shared()->counters().textures, 0U);
  EXPECT_EQ(shared()->counters().texture_bytes, 0U);
}

TEST_F(Textures, ALookThatDoesNotFitItsMeshIsLeftOut) {
  const MeshAppearance good = look_of(red_green_blue_white());
  std::vector<MeshAppearance> bad(5, good);
  bad[0].materials = {0, 7};
  bad[1].places.pop_back();
  bad[2].materials.clear();
  bad[3].colours.resize(1);
  bad[4].places[0].x() = std::nanf("");
  const Image without = picture(textured(nullptr));
  for (const MeshAppearance& look : bad) EXPECT_EQ(count_different(picture(textured(shared_look(look))), without), 0);
  auto broken = red_green_blue_white();
  broken->height = 1000;
  EXPECT_TRUE(picture(textured(shared_look(look_of(broken)))).width > 0);  // white, and nothing is read past its end
}

TEST_F(Textures, ASeamKeepsBothOfItsPlaces) {
  // The right half of the picture, mirrored onto both halves of a sheet of four triangles: the places jump at x = 0.
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  mesh->vertices = {{-1, 0, -1}, {0, 0, -1}, {1, 0, -1}, {1, 0, 1}, {0, 0, 1}, {-1, 0, 1}};
  mesh->triangles = {{0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}};
  MeshAppearance look = look_of(red_green_blue_white());
  look.materials = {0, 0, 0, 0};
  look.places = {{0, 0.4F},    {0.4F, 0.4F}, {0.4F, 0.1F}, {0, 0.4F},    {0.4F, 0.1F}, {0, 0.1F},
                 {0.6F, 0.4F}, {0.9F, 0.4F}, {0.9F, 0.1F}, {0.6F, 0.4F}, {0.9F, 0.1F}, {0.6F, 0.1F}};
  Scene scene;
  add_mesh(scene, mesh, at(0, 0, 0)).look = shared_look(look);
  set(scene, DisplayMode::textures);
  const Image sut = picture(scene);
  for (int x = 55; x < 98; ++x) EXPECT_EQ(hue(sut, x, 100), 0) << x;
  for (int x = 102; x < 145; ++x) EXPECT_EQ(hue(sut, x, 100), 1) << x;
}

}  // namespace
}  // namespace cellmirror::display
