// What the picture thread and `cellmirror snapshot` are made of.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "app/pictures/film.hpp"
#include "app/pictures/picture_file.hpp"
#include "app/pictures/snapshot_request.hpp"
#include "app/render/picked_object.hpp"
#include "app/render/picture_rate.hpp"
#include "app/render/picture_request.hpp"
#include "app/render/picture_streams.hpp"
#include "app/render/render_cache.hpp"
#include "app/render/scene_fingerprint.hpp"
#include "rt_core/ports/tissue_state.hpp"
#include "rt_core/ports/voxel_grid.hpp"

namespace cellmirror::app {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(SnapshotRequest, ArrivesAsItWasAsked) {
  SnapshotRequest wanted;
  wanted.camera = "UMG_Kamera_1";
  wanted.width = 320;
  wanted.height = 200;
  wanted.quality = 70;
  wanted.format = ImageFormat::jpeg;
  const auto parsed = parse_control_request(control_request_line(question(wanted)));
  ASSERT_TRUE(parsed) << parsed.error().text();
  const auto sut = snapshot_request(*parsed);
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->camera, wanted.camera);
  EXPECT_EQ(sut->width, 320);
  EXPECT_EQ(sut->height, 200);
  EXPECT_EQ(sut->quality, 70);
  EXPECT_EQ(sut->format, ImageFormat::jpeg);
  EXPECT_FALSE(sut->view);
  const PictureRequest request = picture_request_of(*sut, 640, 480);
  EXPECT_EQ(request.width, 320);
  EXPECT_TRUE(check_request(request));
}

TEST(SnapshotRequest, UnknownMembersAndOtherThanNumbersAreRefused) {
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"size", "3"}, {"width", "1.5"}, {"width", ""}, {"view", "x"}, {"format", "gif"}, {"height", "99999999999"}})
    EXPECT_FALSE(snapshot_request({"snapshot", {{name, text}}})) << name << " " << text;
}

TEST(SnapshotAnswer, BringsTheFile) {
  EncodedImage picture;
  picture.format = ImageFormat::png;
  picture.width = 3;
  picture.height = 2;
  picture.sequence = 9;
  picture.bytes = {0, 255, 17, 3};
  const auto sut = snapshot_answer(answer_text(picture, 0.25));
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->bytes, picture.bytes);
  EXPECT_EQ(sut->width, 3);
  EXPECT_EQ(sut->sequence, 9U);
  EXPECT_DOUBLE_EQ(sut->posture_age_s, 0.25);
  for (const char* text : {"", "{}", "[]", R"({"format": "png", "width": 1})", "null"})
    EXPECT_FALSE(snapshot_answer(text)) << text;
}

TEST(PictureWish, OutOfRangeIsRefused) {
  const auto refused = [](auto change) {
    PictureRequest request;
    change(request);
    return !check_request(request).has_value();
  };
  EXPECT_FALSE(refused([](auto&) {}));
  EXPECT_TRUE(refused([](auto& w) { w.view = 7; }));
  EXPECT_TRUE(refused([](auto& w) { w.view = -1; }));
  EXPECT_TRUE(refused([](auto& w) { w.width = 15; }));
  EXPECT_TRUE(refused([](auto& w) { w.height = kLargestImageEdge + 1; }));
  EXPECT_TRUE(refused([](auto& w) { w.rate_hz = 0; }));
  EXPECT_TRUE(refused([](auto& w) { w.rate_hz = kNan; }));
  EXPECT_TRUE(refused([](auto& w) { w.rate_hz = 1e-12; }));
  EXPECT_TRUE(refused([](auto& w) { w.quality = 0; }));
  EXPECT_TRUE(refused([](auto& w) { w.view = 0, w.camera = "C"; }));
  EXPECT_FALSE(refused([](auto& w) { w.free_view = View(); }));
  EXPECT_TRUE(refused([](auto& w) { w.free_view = View(), w.free_view->viewpoint.x() = kNan; }));
  EXPECT_TRUE(refused([](auto& w) { w.free_view = View(), w.free_view->lookpoint = w.free_view->viewpoint; }));
  EXPECT_TRUE(refused([](auto& w) { w.free_view = View(), w.free_view->opening_angle = 4; }));
  EXPECT_TRUE(refused([](auto& w) { w.free_view = View(), w.free_view->far_distance = 0; }));
}

TEST(PictureWish, OneDrawingServesOtherRatesAndQualities) {
  PictureRequest a;
  a.free_view = View();
  PictureRequest b = a;
  b.rate_hz = 1;
  b.quality = 5;
  EXPECT_TRUE(same_drawing(a, b));
  b.free_view->twist = 0.1;
  EXPECT_FALSE(same_drawing(a, b));
  b = a;
  b.free_view.reset();
  EXPECT_FALSE(same_drawing(a, b));
}

std::shared_ptr<const EncodedImage> numbered(std::uint64_t sequence) {
  auto picture = std::make_shared<EncodedImage>();
  picture->sequence = sequence;
  return picture;
}

TEST(PictureStreams, NewestWinsAndIsGivenOnce) {
  ManualClock clock;
  clock.set(Timestamp{1});
  PictureStreams sut(clock);
  const auto stream = sut.open({});
  EXPECT_EQ(stream->newest(0), nullptr);
  const auto observer = sut.all().at(0);
  observer->show(numbered(1), {});
  observer->show(numbered(2), {});
  ASSERT_NE(stream->newest(0), nullptr);
  EXPECT_EQ(stream->newest(0)->sequence, 2U);
  EXPECT_EQ(stream->newest(2), nullptr);
}

TEST(PictureStreams, PictureOfAnEarlierWishIsNotShown) {
  ManualClock clock;
  PictureStreams sut(clock);
  const auto stream = sut.open({});
  const auto observer = sut.all().at(0);
  observer->show(numbered(1), {});
  PictureRequest other;
  other.view = 3;
  stream->change(other);
  EXPECT_EQ(stream->newest(0), nullptr);
  observer->show(numbered(2), {});
  EXPECT_EQ(stream->newest(0), nullptr);
  observer->show(numbered(3), other);
  EXPECT_EQ(stream->newest(0)->sequence, 3U);
  other.width = 1;
  stream->change(other);
  EXPECT_EQ(observer->request().width, 640) << "a wish that nobody can fulfil changes nothing";
}

PictureRequest seen_from(double x) {
  PictureRequest request;
  request.free_view = View();
  request.free_view->viewpoint.x() = x;
  return request;
}

// A view that is turned by hand is another request with every picture.
TEST(RenderCache, TakeNoMoreMemoryThanThereAreThatLook) {
  RenderCache sut;
  const PictureRequest stays;
  const std::uint8_t* const kept = [&] {
    RenderedPicture& rendered = sut.of(stays);
    rendered.image.rgba.resize(100);
    return rendered.image.rgba.data();
  }();
  const std::uint8_t* turned = nullptr;
  for (int i = 0; i < 20; ++i) {
    const std::vector<PictureRequest> requests = {stays, seen_from(i)};
    sut.keep(requests);
    RenderedPicture& rendered = sut.of(requests[1]);
    EXPECT_FALSE(rendered.drawn.known()) << i;
    rendered.image.rgba.resize(100);
    rendered.drawn = Timestamp{1};
    if (turned != nullptr) {
      EXPECT_EQ(rendered.image.rgba.data(), turned) << i;
    }
    turned = rendered.image.rgba.data();
    EXPECT_EQ(sut.images(), 2U) << i;
  }
  EXPECT_EQ(sut.of(stays).image.rgba.data(), kept);
  EXPECT_TRUE(sut.of(seen_from(19)).drawn.known());
  sut.keep({});
  EXPECT_EQ(sut.images(), 0U) << "nobody looks";
}

TEST(PictureRate, ALowRateThatWasWishedBeforeHoldsBackNothing) {
  constexpr Nanoseconds kHalf{25'000'000};
  Timestamp due;
  Timestamp now{1'000'000'000};
  EXPECT_TRUE(picture_is_due(due, kLowestPictureRate, now, kHalf));
  now = now + 2 * kHalf;
  EXPECT_FALSE(picture_is_due(due, kLowestPictureRate, now, kHalf));
  int pictures = 0;
  for (int i = 0; i < 20; ++i) {
    now = now + 2 * kHalf;
    pictures += picture_is_due(due, 10, now, kHalf) ? 1 : 0;
  }
  EXPECT_EQ(pictures, 9) << "in a second, from a tenth of it on";
}

TEST(PictureRate, EveryRateHasAPeriod) {
  for (const double rate : {0.0, 1e-300, 1e-12, -1.0}) EXPECT_EQ(picture_period(rate), Nanoseconds(100'000'000'000));
  EXPECT_EQ(picture_period(20), Nanoseconds(50'000'000));
}

// Somebody else looked at it before, or the client itself: what was drawn then is shown at once.
TEST(PictureStreams, PictureThatWasDrawnEarlierIsShownToo) {
  ManualClock clock;
  PictureStreams sut(clock);
  const auto stream = sut.open({});
  const auto observer = sut.all().at(0);
  observer->show(numbered(9), {});
  EXPECT_EQ(stream->newest(0)->sequence, 9U);
  PictureRequest other;
  other.view = 3;
  stream->change(other);
  observer->show(numbered(4), other);
  ASSERT_NE(stream->newest(9), nullptr);
  EXPECT_EQ(stream->newest(9)->sequence, 4U);
  stream->change({});
  observer->show(numbered(9), {});
  ASSERT_NE(stream->newest(4), nullptr);
}

TEST(PictureStreams, TellWhyThereIsNoPictureOfWhatIsWishedNow) {
  ManualClock clock;
  PictureStreams sut(clock);
  const auto stream = sut.open({});
  const auto observer = sut.all().at(0);
  EXPECT_EQ(stream->problem(), "");
  observer->report_problem(Error{"gone", ""}, {});
  EXPECT_EQ(stream->problem(), "gone");
  PictureRequest other;
  other.camera = "C";
  stream->change(other);
  EXPECT_EQ(stream->problem(), "");
  observer->report_problem(Error{"late", ""}, {});
  EXPECT_EQ(stream->problem(), "") << "of what was wished before";
  observer->report_problem(Error{"no camera C", ""}, other);
  EXPECT_EQ(stream->problem(), "no camera C");
  observer->show(numbered(2), other);
  EXPECT_EQ(stream->problem(), "");
}

// Nothing is drawn for a client that stands still.
TEST(PictureStreams, WhoDoesNotAskDoesNotLook) {
  ManualClock clock;
  clock.set(Timestamp{1});
  PictureStreams sut(clock);
  const auto stream = sut.open({});
  const auto observer = sut.all().at(0);
  EXPECT_TRUE(observer->looks(clock.now()));
  clock.advance(PictureObserver::kObserverTimeout);
  EXPECT_FALSE(observer->looks(clock.now()));
  static_cast<void>(stream->newest(0));
  EXPECT_TRUE(observer->looks(clock.now()));
}

TEST(PictureStreams, AreBoundedAndEndWithTheirClients) {
  ManualClock clock;
  PictureStreams sut(clock);
  std::vector<std::unique_ptr<PictureStream>> streams;
  for (std::size_t i = 0; i < PictureStreams::kMost; ++i) streams.push_back(sut.open({}));
  EXPECT_EQ(sut.open({}), nullptr);
  streams.pop_back();
  EXPECT_EQ(sut.size(), PictureStreams::kMost - 1);
  EXPECT_NE(sut.open({}), nullptr);
}

TEST(SceneFingerprint, ChangesWithEverythingThatIsSeen) {
  Scene scene;
  scene.bodies.resize(2);
  scene.labels.resize(1);
  scene.lines.resize(1);
  std::vector<Pane> panes(1);
  const std::uint64_t before = fingerprint(scene, panes);
  scene.posture_time = Timestamp{5};
  EXPECT_EQ(fingerprint(scene, panes), before) << "time alone is not seen";
  const auto differs = [&](auto change) {
    Scene changed = scene;
    std::vector<Pane> changed_panes = panes;
    change(changed, changed_panes);
    return fingerprint(changed, changed_panes) != before;
  };
  EXPECT_TRUE(differs([](Scene& s, auto&) { s.bodies[1].X_WG.translation().x() = 1e-9; }));
  EXPECT_TRUE(differs([](Scene& s, auto&) { s.bodies[0].mark = Mark::near; }));
  EXPECT_TRUE(differs([](Scene& s, auto&) { s.bodies[0].rgba[2] = 0.1F; }));
  EXPECT_TRUE(differs([](Scene& s, auto&) { s.labels[0].text = "x"; }));
  EXPECT_TRUE(differs([](Scene& s, auto&) { s.lines[0].dashed = true; }));
  EXPECT_TRUE(differs([](Scene& s, auto&) { s.messages = {"hello"}; }));
  EXPECT_TRUE(differs([](Scene& s, auto&) { s.sparks.resize(1); }));
  EXPECT_TRUE(differs([](Scene& s, auto&) { s.modes.set(0); }));
  EXPECT_TRUE(differs([](Scene&, auto& p) { p[0].eye.opening_angle = 1; }));
  EXPECT_TRUE(differs([](Scene&, auto& p) { p.resize(2); }));
}

TEST(SceneFingerprint, ChangesWithTheStepOfTissueAndWithWhatChangesBetweenSteps) {
  TissueView view;
  view.step = 7;
  view.surfaces.resize(1);
  const auto print_of = [](const TissueView& shown) {
    Scene scene;
    scene.tissue = std::make_shared<const TissueView>(shown);
    return fingerprint(scene, {});
  };
  const std::uint64_t before = print_of(view);
  EXPECT_EQ(print_of(view), before) << "another copy of the same";
  EXPECT_NE(fingerprint(Scene{}, {}), before);
  const auto differs = [&](auto change) {
    TissueView changed = view;
    change(changed);
    return print_of(changed) != before;
  };
  EXPECT_TRUE(differs([](TissueView& v) { v.step = 8; }));
  EXPECT_TRUE(differs([](TissueView& v) { v.lens_fog = 0.1; }));
  EXPECT_TRUE(differs([](TissueView& v) { v.surfaces[0].visible = false; }));
  EXPECT_TRUE(differs([](TissueView& v) { v.network.nodes.resize(1); }));
  EXPECT_TRUE(differs([](TissueView& v) { v.clips.resize(1); }));
  EXPECT_TRUE(differs([](TissueView& v) { v.pool.blood = 0.5; }));
  Scene scene;
  scene.tissue = std::make_shared<const TissueView>(view);
  scene.tissue_modes = {DrawMode::flat};
  EXPECT_NE(fingerprint(scene, {}), before);
}

TEST(SceneFingerprint, ChangesWithAllThatIsSeenOfAVolume) {
  Scene scene;
  scene.volumes.resize(1);
  const std::uint64_t before = fingerprint(scene, {});
  EXPECT_NE(fingerprint(Scene{}, {}), before);
  const auto differs = [&](auto change) {
    Scene changed = scene;
    change(changed.volumes[0]);
    return fingerprint(changed, {}) != before && volume_fingerprint(changed) != volume_fingerprint(scene);
  };
  Scene moved = scene;
  moved.bodies.resize(1);
  EXPECT_NE(fingerprint(moved, {}), before);
  EXPECT_EQ(volume_fingerprint(moved), volume_fingerprint(scene)) << "what else is seen does not matter";
  EXPECT_TRUE(differs([](SceneVolume& v) { v.grid = std::make_shared<const VoxelGrid>(); }));
  EXPECT_TRUE(differs([](SceneVolume& v) { v.X_WV.translation().z() = 1e-9; }));
  EXPECT_TRUE(differs([](SceneVolume& v) { v.settings.table = VolumeTable::linear; }));
  EXPECT_TRUE(differs([](SceneVolume& v) { v.settings.medical.fat = 0.2; }));
  EXPECT_TRUE(differs([](SceneVolume& v) { v.settings.parameters[3].gain = 2; }));
  EXPECT_TRUE(differs([](SceneVolume& v) { v.settings.planes[5].side = VolumePlaneSide::before; }));
  EXPECT_TRUE(differs([](SceneVolume& v) { v.settings.planes[5].framed = true; }));
  EXPECT_TRUE(differs([](SceneVolume& v) { v.settings.planes[0].distance_m = 0.001; }));
  EXPECT_TRUE(differs([](SceneVolume& v) { v.settings.isosurface = true; }));
  EXPECT_TRUE(differs([](SceneVolume& v) { v.user_tables[1] = std::make_shared<const VolumeUserTable>(); }));
  EXPECT_TRUE(differs([](SceneVolume& v) { v.tables_revision = 2; }));
}

TEST(PictureFile, FormatIsTheExtensions) {
  EXPECT_EQ(picture_format("a.png"), ImageFormat::png);
  EXPECT_EQ(picture_format("A.JPG"), ImageFormat::jpeg);
  EXPECT_EQ(picture_format("b.jpeg"), ImageFormat::jpeg);
  EXPECT_FALSE(picture_format("b.gif"));
  EXPECT_FALSE(picture_format("png"));
}

class CountingSink final : public FilmSink {
 public:
  Result<void> add(std::span<const std::uint8_t> jpeg) override {
    frames.push_back(jpeg[0]);
    return {};
  }
  Result<std::string> finish() override { return std::string(); }
  std::vector<std::uint8_t> frames;
};

// Each place of the film is filled, by the picture before where one was late.
TEST(Film, KeepsTheTime) {
  CountingSink sink;
  std::uint8_t number = 0;
  const auto take = [&]() -> Result<SnapshotAnswer> {
    SnapshotAnswer answer;
    answer.bytes = {++number};
    return answer;
  };
  const auto totals = take_film(take, 0.1, 50, sink, [] { return false; });
  ASSERT_TRUE(totals);
  EXPECT_EQ(totals->frames, 5U);
  EXPECT_EQ(sink.frames.size(), 5U);
  EXPECT_EQ(totals->frames - totals->repeated, number);
}

TEST(Film, EndsWithTheFirstFailure) {
  CountingSink sink;
  const auto totals =
      take_film([]() -> Result<SnapshotAnswer> { return fail("gone"); }, 1, 10, sink, [] { return false; });
  ASSERT_FALSE(totals);
  EXPECT_EQ(totals.error().what, "gone");
}

TEST(PickedObject, NamesTheNodeAndItsRobot) {
  CompiledCell cell;
  cell.parent = {-1, 0, 1};
  cell.naming_parent = {-1, 0, 1};
  cell.paths = std::make_shared<const std::vector<std::string>>(std::vector<std::string>{"", "Arm", "Arm.J_1"});
  cell.robots.resize(1);
  cell.robots[0].id = "ARM";
  cell.robots[0].component = 1;
  EXPECT_FALSE(picked_object(cell, 0));
  EXPECT_FALSE(picked_object(cell, 4)) << "of a cell that was larger";
  const auto sut = picked_object(cell, 3);
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->path, "Arm.J_1");
  EXPECT_EQ(sut->robot, "ARM");
  EXPECT_EQ(picked_object(cell, 1)->robot, "");
}

}  // namespace
}  // namespace cellmirror::app
