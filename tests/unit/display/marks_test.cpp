// Lines, frames, cones, arrows, traces, sparks and words are where they belong.
#include "tests/unit/display/renderer_fixture.hpp"

namespace cellmirror::display {
namespace {

class DisplayMarks : public RendererTest {
 protected:
  // How many pixels of a region the change makes different.
  static int change(const Region& region, const std::function<void(Scene&)>& add, Scene scene = {}) {
    const Image before = picture(scene);
    add(scene);
    return count_different(before, picture(scene), region);
  }
  static constexpr Region kAll{0, 0, kEdge, kEdge};
};

TEST_F(DisplayMarks, ALineHasItsWidthInPixels) {
  const auto line = [](float width) {
    return [width](Scene& scene) { scene.lines.push_back({{-1, 0, 0}, {1, 0, 0}, {0, 0, 0, 1}, width}); };
  };
  EXPECT_NEAR(change(kAll, line(3)), 300, 120);
  EXPECT_NEAR(change(kAll, line(9)), 900, 150);
  EXPECT_EQ(change({0, 0, kEdge, 80}, line(9)), 0);
}

TEST_F(DisplayMarks, ADashedLineHasGaps) {
  const auto line = [](bool dashed) {
    return [dashed](Scene& scene) { scene.lines.push_back({{-1, 0, 0}, {1, 0, 0}, {0, 0, 0, 1}, 3, dashed}); };
  };
  const int solid = change(kAll, line(false));
  const int dashed = change(kAll, line(true));
  EXPECT_LT(dashed, 0.8 * solid);
  EXPECT_GT(dashed, 0.3 * solid);
}

TEST_F(DisplayMarks, OnlyALineOnTopIsNotHidden) {
  Scene scene;
  add_box(scene, {1, 1, 1}, at(0, 0, 0));
  const auto line = [](bool on_top) {
    return [on_top](Scene& s) { s.lines.push_back({{-0.4, 0, 0}, {0.4, 0, 0}, {0, 0, 0, 1}, 2, false, on_top}); };
  };
  EXPECT_EQ(change(kAll, line(false), scene), 0);
  EXPECT_GT(change(kAll, line(true), scene), 50);
}

TEST_F(DisplayMarks, ALineThroughTheEyeIsCut) {
  EXPECT_GT(change(kAll, [](Scene& s) { s.lines.push_back({{0.5, -100, -1}, {0.6, 100, 1}, {0, 0, 0, 1}, 2}); }), 3);
}

TEST_F(DisplayMarks, AxesShowTheirDirectionsInRedGreenBlue) {
  Scene scene;
  scene.axes.push_back({at(0, 0, 0), 1.0, true, ""});
  const Image sut = picture(scene);
  const std::uint8_t* const x = sut.pixel(125, 100);
  const std::uint8_t* const z = sut.pixel(100, 75);
  EXPECT_GT(x[0], x[1] + 60);
  EXPECT_GT(z[2], z[0] + 60);
  const Image above = picture(scene, from_above());
  const std::uint8_t* const y = above.pixel(100, 75);
  EXPECT_GT(y[1], y[0] + 40);
}

TEST_F(DisplayMarks, EmphasizedAxesAreThicker) {
  const auto axes = [](bool emphasized) {
    return [emphasized](Scene& s) { s.axes.push_back({at(0, 0, 0), 1.0, emphasized, ""}); };
  };
  EXPECT_GT(change(kAll, axes(true)), 1.3 * change(kAll, axes(false)));
}

TEST_F(DisplayMarks, AFrameInsideOfABodyShinesThrough) {
  Scene scene;
  add_box(scene, {2, 2, 2}, at(0, 0, 0));
  EXPECT_GT(change(kAll, [](Scene& s) { s.axes.push_back({at(0, 0, 0), 0.8, true, ""}); }, scene), 50);
}

TEST_F(DisplayMarks, AConeOpensAlongItsAxisAndIsSeenThrough) {
  Scene scene;
  add_box(scene, {0.3, 0.3, 0.3}, at(0, 0, 1));
  const auto cone = [](Scene& s) {
    SceneCone& added = s.cones.emplace_back();
    added.half_angle_rad = 0.4;
    added.length_m = 1.5;
    added.rgba = {0.1F, 0.3F, 0.9F, 0.3F};
  };
  const int upper = change({0, 0, kEdge, 98}, cone, scene);
  EXPECT_GT(upper, 1200);
  EXPECT_EQ(change({0, 106, kEdge, 94}, cone, scene), 0);
  Scene with = scene;
  cone(with);
  EXPECT_GT(count_different(picture(with), picture([&] {
                              Scene bare = with;
                              bare.bodies.clear();
                              return bare;
                            }())),
            100);
}

TEST_F(DisplayMarks, AnArrowPointsWhereItShould) {
  const auto arrow = [](bool torque) {
    return [torque](Scene& s) { s.arrows.push_back({{0, 0, 0}, {0, 0, 1.2}, {0, 0.5F, 0.3F, 1}, torque}); };
  };
  EXPECT_GT(change({90, 40, 20, 60}, arrow(false)), 100);
  EXPECT_EQ(change({0, 110, kEdge, 90}, arrow(false)), 0);
  // A torque has a second head.
  EXPECT_GT(change(kAll, arrow(true)), change(kAll, arrow(false)) + 4);
}

TEST_F(DisplayMarks, OlderPartsOfATraceArePaler) {
  Scene scene;
  SceneTrace& trace = scene.traces.emplace_back();
  for (int i = 0; i <= 100; ++i) trace.points.emplace_back(-1.0F + 0.02F * static_cast<float>(i), 0.0F, 0.0F);
  const Image sut = picture(scene);
  EXPECT_GT(mean_brightness(sut, {55, 100, 10, 1}), mean_brightness(sut, {135, 100, 10, 1}) + 60);
}

TEST_F(DisplayMarks, ASparkFlickersWithItsPhase) {
  const auto spark = [](std::uint32_t phase) { return [phase](Scene& s) { s.sparks.push_back({{0, 0, 0}, phase}); }; };
  EXPECT_GT(change(around(100, 100, 12), spark(1)), 50);
  Scene one;
  Scene two;
  spark(1)(one);
  spark(2)(two);
  EXPECT_GT(count_different(picture(one), picture(two)), 20);
  EXPECT_EQ(count_different(picture(one), picture(one)), 0);
}

TEST_F(DisplayMarks, ALabelIsDarkOnPaleAndNeverHidden) {
  Scene scene;
  add_box(scene, {3, 0.5, 3}, at(0, -2, 0)).rgba = {0.2F, 0.2F, 0.3F, 1};
  scene.labels.push_back({{0, 0, 0}, "US_2: 1.28 m", Mark::none});
  const Image sut = picture(scene);
  int dark = 0;
  int pale = 0;
  for (int y = 78; y < 104; ++y) {
    for (int x = 55; x < 145; ++x) {
      dark += brightness(sut.pixel(x, y)) < 40 ? 1 : 0;
      pale += brightness(sut.pixel(x, y)) > 180 ? 1 : 0;
    }
  }
  EXPECT_GT(dark, 60);
  EXPECT_GT(pale, 100);
}

TEST_F(DisplayMarks, LabelsDoNotLieOverEachOther) {
  const auto labels = [](int count) {
    return [count](Scene& s) {
      for (int i = 0; i < count; ++i) s.labels.push_back({{0, 0, 0}, "label " + std::to_string(i), Mark::none});
    };
  };
  const int one = change(kAll, labels(1));
  EXPECT_NEAR(change(kAll, labels(4)), 4 * one, one);
}

TEST_F(DisplayMarks, ALabelBehindTheEyeIsNotDrawn) {
  EXPECT_EQ(change(kAll, [](Scene& s) { s.labels.push_back({{0, -20, 0}, "behind", Mark::none}); }), 0);
}

TEST_F(DisplayMarks, TheLegendIsBelowOnTheLeft) {
  const auto legend = [](Scene& s) { s.legend = {{{1, 0, 0, 1}, "a"}, {{0, 0, 1, 1}, "b"}}; };
  EXPECT_GT(change({0, 100, 100, 100}, legend), 300);
  EXPECT_EQ(change({0, 0, kEdge, 100}, legend), 0);
  EXPECT_EQ(change({100, 0, 100, kEdge}, legend), 0);
}

TEST_F(DisplayMarks, MessagesAreAboveInTheMiddle) {
  const auto messages = [](Scene& s) { s.messages = {"ready"}; };
  EXPECT_GT(change({50, 0, 100, 80}, messages), 300);
  EXPECT_EQ(change({0, 100, kEdge, 100}, messages), 0);
}

TEST_F(DisplayMarks, PanesHaveTheirOwnEyesTitlesAndBorders) {
  Scene scene;
  add_box(scene, {1, 1, 1}, at(0, 0, 0));
  Pane left = level();
  left.width = 0.5;
  left.title = "View 1";
  Pane right = level();
  right.left = 0.5;
  right.width = 0.5;
  right.eye.X_WE.translation().x() = 50;  // sees nothing
  std::vector<std::uint32_t> numbers;
  ASSERT_TRUE(shared()->objects(scene, std::vector<Pane>{left, right}, kEdge, kEdge, numbers));
  EXPECT_EQ(numbers[100 * kEdge + 50], 1U);
  for (std::size_t y = 0; y < kEdge; ++y) EXPECT_EQ(numbers[y * kEdge + 150], 0U);
  const Image sut = picture(scene, std::vector<Pane>{left, right});
  EXPECT_LT(brightness(sut.pixel(100, 150)), brightness(sut.pixel(150, 150)) - 30);  // the border
  left.title.clear();
  const Image untitled = picture(scene, std::vector<Pane>{left, right});
  EXPECT_GT(count_different(sut, untitled, {0, 0, 80, 30}), 60);
  EXPECT_EQ(count_different(sut, untitled, {100, 0, 100, 200}), 0);
}

}  // namespace
}  // namespace cellmirror::display
