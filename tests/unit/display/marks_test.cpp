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

TEST_F(DisplayMarks, AnArrowInsideOfABodyShinesThroughPaler) {
  Scene scene;
  add_box(scene, {2, 2, 2}, at(0, 0, 0));
  const auto arrow = [](bool torque) {
    return [torque](Scene& s) { s.arrows.push_back({{0, 0, -0.6}, {0, 0, 1.2}, {0, 0.5F, 0.3F, 1}, torque}); };
  };
  constexpr Region kShaft{97, 96, 7, 30};
  constexpr Region kHead{90, 69, 21, 10};
  EXPECT_GT(change(kShaft, arrow(false), scene), 50);
  EXPECT_GT(change(kHead, arrow(false), scene), 40) << "as wide as its base";
  EXPECT_GT(change(kAll, arrow(true), scene), change(kAll, arrow(false), scene) + 10) << "the second head";
  const Image inside = [&] {
    Scene with = scene;
    arrow(false)(with);
    return picture(with);
  }();
  scene.bodies.clear();
  arrow(false)(scene);
  const Image bare = picture(scene);
  EXPECT_GT(brightness(inside.pixel(100, 110)), brightness(bare.pixel(100, 110)) + 20);
}

TEST_F(DisplayMarks, AnArrowTowardsTheViewerHasNoEdgesBesideItsHead) {
  Scene scene;
  scene.arrows.push_back({{0, 0, 0}, {0, -1.2, 0}, {0, 0.5F, 0.3F, 1}, false});
  const Image sut = picture(scene);
  EXPECT_EQ(count_different(sut, picture(Scene{}), {0, 0, kEdge, 85}), 0);
  EXPECT_GT(count_different(sut, picture(Scene{}), around(100, 100)), 10);
}

TEST_F(DisplayMarks, WhatBelongsToACameraIsNotInItsOwnPicture) {
  Scene scene;
  scene.lines.push_back({.from = {-1, 0, 0}, .to = {1, 0, 0}, .camera = 7});
  scene.labels.push_back({{0, 0, 1}, "CAM", Mark::none, 7});
  const Image none = picture(Scene{});
  Pane pane = level();
  pane.camera = 7;
  EXPECT_EQ(count_different(picture(scene, pane), none), 0);
  pane.camera = 8;
  EXPECT_GT(count_different(picture(scene, pane), none, {0, 90, kEdge, 20}), 80);
  EXPECT_GT(count_different(picture(scene), none, {0, 20, kEdge, 60}), 60);
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

class DisplayMessages : public DisplayMarks {
 protected:
  static Image with(const std::string& text, int width = kEdge) {
    Scene scene;
    scene.messages = {text};
    Image image;
    EXPECT_TRUE(shared()->draw(scene, std::vector<Pane>{level()}, width, kEdge, image));
    return image;
  }
  static Image without(int width = kEdge) {
    Image image;
    EXPECT_TRUE(shared()->draw({}, std::vector<Pane>{level()}, width, kEdge, image));
    return image;
  }
  // Rows that the message takes.
  static int height_of(const Image& picture) {
    const Image empty = without(picture.width);
    int rows = 0;
    for (int y = 0; y < kEdge; ++y) rows += count_different(picture, empty, {0, y, picture.width, 1}) > 0 ? 1 : 0;
    return rows;
  }
};

TEST_F(DisplayMessages, ALongOneIsBrokenAtBlanksAndSeenAsAWhole) {
  const std::string text = "the joint J_4 of the arm gives more than";
  const Image sut = with(text);
  for (const int x : {0, kEdge - 3}) EXPECT_EQ(count_different(sut, without(), {x, 0, 3, kEdge}), 0) << x;
  EXPECT_GT(count_different(sut, with("the joint J_4 of the arm gives less than")), 10) << "in its second line";
  EXPECT_GT(height_of(sut), height_of(with("ready")) + 10);
}

TEST_F(DisplayMessages, AWordLongerThanALineIsBroken) {
  const std::string word(60, 'w');
  EXPECT_EQ(count_different(with(word), without(), {kEdge - 3, 0, 3, kEdge}), 0);
  EXPECT_GT(height_of(with(word)), 2 * height_of(with("w")));
}

TEST_F(DisplayMessages, BeyondTheFourthLineIsAnEllipsis) {
  std::string text;
  for (int i = 0; i < 40; ++i) text += "many words ";
  const Image sut = with(text);
  EXPECT_EQ(count_different(sut, with(text + "and more")), 0);
  EXPECT_LT(height_of(sut), 5 * height_of(with("ready")));
  EXPECT_EQ(count_different(sut, without(), {kEdge - 3, 0, 3, kEdge}), 0);
}

TEST_F(DisplayMessages, AWiderPictureHasFewerLines) {
  const std::string text = "the joint J_4 of the arm gives more than it may";
  EXPECT_LT(height_of(with(text, 640)), height_of(with(text)));
  EXPECT_EQ(height_of(with(text, 640)), height_of(with("joint", 640)));
}

TEST_F(DisplayMessages, WhereThereIsNoRoomForAllTheNewestIsSeen) {
  Scene scene;
  for (int i = 0; i < 6; ++i) scene.messages.emplace_back("of these messages the older ones are left out, not this");
  const Image same = picture(scene);
  scene.messages.back() = "the newest";
  EXPECT_GT(count_different(same, picture(scene)), 100);
  scene.messages.assign(1, std::string(400, 'i'));
  EXPECT_GT(height_of(picture(scene)), 40) << "one that is too high is seen as far as there is room";
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
