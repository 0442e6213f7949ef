// What belongs to tissue beside its surfaces: clips, particles, fluid, the network, fog.
#include "rt_core/ports/palette.hpp"
#include "tests/unit/display/renderer_fixture.hpp"
#include "tests/unit/display/tissue_scenes.hpp"

namespace cellmirror::display {
namespace {

constexpr float kBad = std::numeric_limits<float>::quiet_NaN();

class TissueParts : public RendererTest {
 protected:
  static TissuePool pool() {
    TissuePool pool;
    pool.present = true;
    pool.size_m = {2, 2};
    pool.rgba = {0.5F, 0.6F, 0.9F, 0.5F};
    return pool;
  }
  static Image drawn(TissueView view, const Pane& pane = level()) {
    return picture(with_tissue(std::move(view)), pane);
  }
  static Image with_pool(const TissuePool& pool, const Pane& pane) {
    TissueView view;
    view.pool = pool;
    return drawn(view, pane);
  }
  static TissueClip clip() {
    TissueClip clip;
    clip.vertices = std::make_shared<const std::vector<Eigen::Vector3f>>(
        std::vector<Eigen::Vector3f>{{-0.5F, 0, -0.5F}, {0.5F, 0, -0.5F}, {0, 0, 0.5F}});
    clip.triangles = std::make_shared<const std::vector<std::array<std::uint32_t, 3>>>(
        std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}});
    return clip;
  }
  static TissueNetwork network() {
    TissueNetwork network;
    network.nodes = {{-1, 0, 1}, {1, 0, 1}, {-1, 0, -1}, {1, 0, -1}};
    network.kinds = {TissueNodeKind::inner, TissueNodeKind::outer, TissueNodeKind::contact, TissueNodeKind::fixed};
    network.links = {{0, 1}, {0, 2}, {1, 3}};
    return network;
  }
  static Image with_network(const TissueNetwork& network) {
    TissueView view;
    view.network = network;
    return drawn(view);
  }
  static Pane camera(Pane pane = level()) {
    pane.camera = 7;
    return pane;
  }
};

TEST_F(TissueParts, APoolTintsWhatItCoversAndNothingAboveIt) {
  Scene scene;
  add_box(scene, {0.4, 0.4, 0.4}, at(-0.5, 0, -0.5)).rgba = {0.9F, 0.9F, 0.9F, 1};
  add_box(scene, {0.4, 0.4, 0.4}, at(0.5, 0, 0.5)).rgba = {0.9F, 0.9F, 0.9F, 1};
  const Image dry = picture(scene, from_above());
  TissueView view;
  view.pool = pool();
  scene.tissue = std::make_shared<const TissueView>(view);
  const Image wet = picture(scene, from_above());
  EXPECT_GT(count_different(dry, wet, around(75, 100, 4)), 60);
  EXPECT_EQ(count_different(dry, wet, around(125, 100, 4)), 0) << "above the surface";
  EXPECT_EQ(count_different(dry, wet, {0, 0, 200, 45}), 0) << "beside the pool";
  view.pool.rgba[3] = 1;
  view.pool.level_m = 1;
  scene.tissue = std::make_shared<const TissueView>(view);
  const Image deep = picture(scene, from_above());
  EXPECT_FALSE(differ(deep.pixel(125, 100), deep.pixel(75, 100), 3)) << "both are hidden";
}

TEST_F(TissueParts, APoolHasItsColour) {
  TissuePool sut = pool();
  const Image clear = with_pool(sut, from_above());
  sut.rgba = {0.5F, 0.1F, 0.1F, 0.5F};
  const Image red = with_pool(sut, from_above());
  const auto redness = [](const Image& image) { return image.pixel(80, 90)[0] - image.pixel(80, 90)[2]; };
  EXPECT_LT(redness(clear), 0);
  EXPECT_GT(redness(red), redness(clear) + 60);
}

TEST_F(TissueParts, RipplesAreSeen) {
  TissuePool sut = pool();
  sut.columns = 40;
  sut.heights_m.assign(40 * 30, 0.0F);
  const Image level_one = with_pool(sut, from_above());
  EXPECT_EQ(count_different(level_one, with_pool(pool(), from_above())), 0) << "no heights: level";
  for (std::size_t i = 0; i < sut.heights_m.size(); ++i)
    sut.heights_m[i] = 0.02F * std::sin(static_cast<float>(i % 40) * 0.9F);
  EXPECT_GT(distinct_colours(with_pool(sut, from_above()), around(100, 100, 20)),
            distinct_colours(level_one, around(100, 100, 20)) + 10);
}

TEST_F(TissueParts, ARowOfHeightsLiesAlongX) {
  TissuePool sut = pool();
  sut.rgba[3] = 1;
  sut.columns = 3;
  sut.heights_m = {0, 0, 0, 0, 0, 0.5F};  // high at the greatest x and y
  const Image image = with_pool(sut, level());
  const Image empty = picture(Scene{});
  EXPECT_GT(count_different(image, empty, {138, 88, 10, 8}), 40);
  EXPECT_EQ(count_different(image, empty, {52, 80, 40, 12}), 0);
}

TEST_F(TissueParts, PoolsThatMakeNoSenseAreLeftOutAndHeightsThatDoNotFitLevel) {
  const Image empty = picture(Scene{}, from_above());
  for (int i = 0; i < 7; ++i) {
    TissuePool sut = pool();
    if (i == 0) sut.present = false;
    if (i == 1) sut.X_WP.translation().x() = std::nan("");
    if (i == 2) sut.size_m.x() = 0;
    if (i == 3) sut.size_m.y() = kBad;
    if (i == 4) sut.level_m = std::numeric_limits<double>::infinity();
    if (i == 5) sut.size_m.x() = 1e30F;
    if (i == 6) sut.rgba[3] = 0;
    EXPECT_EQ(count_different(with_pool(sut, from_above()), empty), 0) << i;
  }
  const Image level_one = with_pool(pool(), from_above());
  for (const auto& [columns, count] :
       {std::pair(0, 9), {1, 9}, {4, 9}, {3, 0}, {3, 3}, {65535, 65535 * 2}, {7, 7 * 5000}}) {
    TissuePool sut = pool();
    sut.columns = static_cast<std::uint16_t>(columns);
    sut.heights_m.assign(static_cast<std::size_t>(count), 0.5F);
    EXPECT_EQ(count_different(with_pool(sut, from_above()), level_one), 0) << columns << ' ' << count;
  }
  TissuePool sut = pool();
  sut.blood = std::nan("");
  sut.columns = 3;
  sut.heights_m.assign(9, kBad);
  EXPECT_EQ(count_different(with_pool(sut, from_above()), level_one), 0);
}

TEST_F(TissueParts, DropsOfBloodAreDarkRedAndRound) {
  TissueView view;
  view.particles.push_back({{0, 0, 0}, 0.4F, 0, 0});
  const Image sut = drawn(view);
  const std::uint8_t* const middle = sut.pixel(104, 104);
  EXPECT_GT(middle[0], middle[2] + 40);
  EXPECT_NEAR(count_different(sut, picture(Scene{})), std::numbers::pi * 400, 70);
  view.particles[0].age = 1;
  EXPECT_EQ(count_different(drawn(view), picture(Scene{})), 0) << "vanished";
}

TEST_F(TissueParts, SmallDropsAreStillSeen) {
  TissueView view;
  for (int i = 0; i < 50; ++i)
    view.particles.push_back({{0.1F * static_cast<float>(i % 10), 0, 0.013F * static_cast<float>(i)}, 0.0005F, 0, 0});
  EXPECT_GT(count_different(drawn(view), picture(Scene{})), 40);
}

TEST_F(TissueParts, SmokeIsSoftAndThins) {
  Scene scene;
  add_box(scene, {3, 0.1, 3}, at(0, 1, 0)).rgba = {0.1F, 0.1F, 0.1F, 1};
  const Image before = picture(scene);
  const auto smoke_at_age = [&](float age) {
    TissueView view;
    view.particles.push_back({{0, 0, 0}, 0.6F, 1, age});
    scene.tissue = std::make_shared<const TissueView>(view);
    return picture(scene);
  };
  const Image fresh = smoke_at_age(0);
  const Image old = smoke_at_age(0.7F);
  const auto paler = [&](const Image& image, int x) {
    return brightness(image.pixel(x, 100)) - brightness(before.pixel(x, 100));
  };
  EXPECT_GT(paler(fresh, 100), 25);
  EXPECT_GT(paler(fresh, 100), paler(fresh, 118) + 8);
  EXPECT_GT(paler(fresh, 118), paler(fresh, 129));
  EXPECT_EQ(paler(fresh, 132), 0);
  EXPECT_LT(paler(old, 100), paler(fresh, 100) - 10);
}

TEST_F(TissueParts, ParticlesAreHiddenByWhatIsBeforeThem) {
  TissueView view;
  for (const int kind : {0, 1, 2}) view.particles.push_back({{0, 0, 0}, 0.2F, static_cast<std::uint8_t>(kind), 0});
  Scene scene;
  add_box(scene, {1, 0.1, 1}, at(0, -1, 0));
  const Image before = picture(scene);
  scene.tissue = std::make_shared<const TissueView>(view);
  EXPECT_EQ(count_different(before, picture(scene)), 0);
}

TEST_F(TissueParts, ParticlesThatMakeNoSenseAreLeftOut) {
  TissueView view;
  const TissueParticle good{{0, 0, 0}, 0.1F, 0, 0};
  view.particles.assign(6, good);
  view.particles[0].at.x() = kBad;
  view.particles[1].radius_m = kBad;
  view.particles[2].radius_m = -1;
  view.particles[3].kind = 9;
  view.particles[4].at.z() = 1e30F;
  view.particles[5].radius_m = 1e30F;
  EXPECT_EQ(count_different(drawn(view), picture(Scene{})), 0);
  view.particles.assign(100'000, good);
  for (TissueParticle& particle : view.particles) particle.age = kBad;
  drawn(view);
}

TEST_F(TissueParts, AClipIsAPieceOfMetalAtItsPlace) {
  TissueView view;
  view.clips.push_back(clip());
  view.clips[0].X_WC.translation().x() = 1;
  const Image sut = drawn(view);
  const Image empty = picture(Scene{});
  EXPECT_NEAR(count_different(sut, empty), 1'250, 130);
  EXPECT_EQ(count_different(sut, empty, {0, 0, 110, 200}), 0);
  const std::uint8_t* const metal = sut.pixel(150, 105);
  EXPECT_LT(std::abs(metal[0] - metal[2]), 30);
}

TEST_F(TissueParts, ClipsThatShareAShapeShareItsUpload) {
  TissueView view;
  const TissueClip one = clip();
  view.clips.assign(20, one);
  const std::uint64_t before = shared()->counters().uploads;
  drawn(view);
  drawn(view);
  EXPECT_EQ(shared()->counters().uploads, before + 1);
}

TEST_F(TissueParts, ClipsThatMakeNoSenseAreLeftOut) {
  TissueView view;
  view.clips.assign(4, clip());
  view.clips[0].vertices = nullptr;
  view.clips[1].triangles = nullptr;
  view.clips[2].X_WC.translation().y() = std::nan("");
  view.clips[3].triangles = std::make_shared<const std::vector<std::array<std::uint32_t, 3>>>(
      std::vector<std::array<std::uint32_t, 3>>{{0, 1, 3}});
  EXPECT_EQ(count_different(drawn(view), picture(Scene{})), 0);
}

TEST_F(TissueParts, NodesHaveTheColoursOfTheirKinds) {
  const Image sut = with_network(network());
  const std::uint8_t* const inner = sut.pixel(50, 50);
  const std::uint8_t* const outer = sut.pixel(150, 50);
  const std::uint8_t* const contact = sut.pixel(50, 150);
  const std::uint8_t* const fixed = sut.pixel(150, 150);
  EXPECT_GT(brightness(inner), 130);
  EXPECT_GT(outer[2], outer[0] + 40);
  EXPECT_GT(contact[0], contact[2] + 60);
  EXPECT_LT(brightness(fixed), 50);
}

TEST_F(TissueParts, LinksAreLines) {
  const Image sut = with_network(network());
  const Image empty = picture(Scene{});
  EXPECT_GT(count_different(sut, empty, {80, 48, 40, 5}), 30);
  EXPECT_EQ(count_different(sut, empty, {80, 148, 40, 5}), 0) << "those two are not linked";
}

TEST_F(TissueParts, ASurfaceIsSeenThroughWhileItsNetworkIsShown) {
  TissueView view;
  view.surfaces.push_back(tissue_sheet());
  view.network.nodes = {{0, 0.5F, 0}};
  const Image without_nodes = [&] {
    TissueView other = view;
    other.network = {};
    return drawn(other);
  }();
  const Image sut = drawn(view);
  EXPECT_GT(count_different(without_nodes, sut, around(70, 70)), 100);
  EXPECT_GT(distinct_colours(sut, around(100, 100)), distinct_colours(sut, around(70, 70)) + 1) << "the node behind it";
}

TEST_F(TissueParts, NodesFarAwayAreStillSeen) {
  TissueNetwork sut;
  sut.nodes = {{0, 0, 0}};
  EXPECT_GT(count_different(with_network(sut), picture(Scene{}), around(100, 100)), 3);
}

TEST_F(TissueParts, NetworksThatMakeNoSenseAreLeftOut) {
  TissueNetwork sut = network();
  const Image whole = with_network(sut);
  sut.links.push_back({0, 4});
  sut.links.push_back({0xFFFF'FFFFU, 1});
  EXPECT_EQ(count_different(with_network(sut), whole), 0);
  sut.nodes.push_back({kBad, 0, 0});
  sut.kinds.push_back(TissueNodeKind::fixed);
  sut.nodes.push_back({0, 1e30F, 0});
  sut.kinds.push_back(static_cast<TissueNodeKind>(77));
  sut.links.push_back({4, 5});
  EXPECT_EQ(count_different(with_network(sut), whole), 0);
  sut.kinds.resize(2);
  EXPECT_GT(brightness(with_network(sut).pixel(150, 150)), 130) << "without kinds all are inner ones";
}

TEST_F(TissueParts, FogVeilsThePicturesOfCamerasAlone) {
  Scene scene;
  add_box(scene, {1, 1, 1}, at(0, 0, 0)).rgba = {0.1F, 0.1F, 0.1F, 1};
  const Image clear = picture(scene);
  TissueView view;
  view.lens_fog = 0.6;
  scene.tissue = std::make_shared<const TissueView>(view);
  EXPECT_EQ(count_different(clear, picture(scene)), 0);
  const Image fogged = picture(scene, camera());
  EXPECT_GT(mean_brightness(fogged, around(100, 100)), mean_brightness(clear, around(100, 100)) + 50);
  std::vector<Pane> two(2, level());
  two[0].width = two[1].width = two[1].left = 0.5;
  const Image none = picture(scene, two);
  two[1].camera = 3;
  const Image one = picture(scene, two);
  EXPECT_EQ(count_different(none, one, {0, 0, 98, 200}), 0);
  EXPECT_GT(count_different(none, one, {102, 0, 98, 200}), 10'000);
}

TEST_F(TissueParts, FogAndSmokeAddUp) {
  Scene scene;
  add_box(scene, {4, 1, 4}, at(0, 0, 0)).rgba = {0.1F, 0.1F, 0.1F, 1};
  const auto middle = [&](double fog, double smoke) {
    TissueView view;
    view.lens_fog = fog;
    view.smoke = smoke;
    scene.tissue = std::make_shared<const TissueView>(view);
    return mean_brightness(picture(scene, camera()), around(100, 100));
  };
  const double clear = middle(0, 0);
  EXPECT_GT(middle(0, 0.5), clear + 10);
  EXPECT_GT(middle(0.3, 0), clear + 20);
  EXPECT_GT(middle(0.3, 0.5), middle(0.3, 0) + 5);
  EXPECT_GT(middle(1, 0), middle(0.5, 0) + 20);
  EXPECT_EQ(middle(std::nan(""), std::nan("")), clear);
  EXPECT_EQ(middle(1e300, -1e300), middle(1, 0));
}

TEST_F(TissueParts, TheGalleryIsDrawnFromManySides) {
  const Scene scene = tissue_gallery_scene();
  std::vector<Pane> panes(4, tissue_gallery_pane());
  for (std::size_t i = 0; i < panes.size(); ++i) {
    panes[i].left = 0.25 * static_cast<double>(i);
    panes[i].width = 0.25;
  }
  const Image sut = picture(scene, panes);
  EXPECT_EQ(count_different(sut, picture(scene, panes)), 0);
  for (std::size_t i = 3; i < sut.rgba.size(); i += 4) ASSERT_EQ(sut.rgba[i], 255) << i;
}

}  // namespace
}  // namespace cellmirror::display
