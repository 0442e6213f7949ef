// What SCRIPT sets of the picture changes it where it should (manual 1.2.1, 1.2.3): pixels in regions and under the
// masks of objects, of the transfer cell.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "rt_core/ports/tcp_trace.hpp"
#include "tests/unit/picture/picture_fixture.hpp"

namespace cellmirror::scene {
namespace {

using display::count_different;
using display::Region;

constexpr Region kWhole{0, 0, 240, 180};
constexpr std::string_view kArm = "Mantec_2";  // robot MANTEC_R3

bool reddish(const std::uint8_t* p) { return p[0] > 140 && p[1] < 90 && p[2] < 90; }
bool greenish(const std::uint8_t* p) { return p[1] > 90 && p[0] < 90 && p[2] < 110; }
bool bluish(const std::uint8_t* p) { return p[2] > 130 && p[0] < 90; }

class RenderModes : public PictureTest {
 protected:
  // What changes within the arm's outline, and beside it.
  std::pair<std::size_t, std::size_t> change(DrawRule rule) {
    const Mask arm = mask(kArm);
    EXPECT_GT(arm.count, 1500U);
    const Image before = picture();
    state_.draw_rules.push_back(std::move(rule));
    const Image after = picture();
    return {100 * different(before, after, arm, true) / arm.count, different(before, after, arm, false)};
  }
};

TEST_F(RenderModes, SetAbstractRenderChangesTheWholeBranchAndNothingElse) {
  for (const DrawMode mode : {DrawMode::wireframe, DrawMode::transparent}) {
    state_.draw_rules.clear();
    const auto [inside, outside] = change({std::string(kArm), true, mode});
    EXPECT_GT(inside, 50U);
    EXPECT_LT(outside, 300U) << "but for its outline";
  }
  state_.draw_rules.clear();
  const auto [inside, outside] = change({std::string(kArm), true, DrawMode::flat});
  EXPECT_GT(inside, 5U);
  EXPECT_EQ(outside, 0U);
}

TEST_F(RenderModes, SetFrameRenderChangesItsOwnGeometryAlone) {
  const Mask part = mask("Mantec_2.J_1");
  const Image before = picture();
  state_.draw_rules = {{"Mantec_2.J_1", false, DrawMode::wireframe}};
  const Image after = picture();
  const std::size_t changed = different(before, after, mask(kArm), true);
  EXPECT_GT(changed, 50U);
  state_.draw_rules = {{"Mantec_2.J_1", true, DrawMode::wireframe}};
  EXPECT_GT(different(before, picture(), part, true), changed) << "the branch is more than the frame";
}

TEST_F(RenderModes, TheLastRuleCounts) {
  const Image before = picture();
  state_.draw_rules = {{std::string(kArm), true, DrawMode::wireframe}, {std::string(kArm), true, DrawMode::gouraud}};
  EXPECT_EQ(count_different(before, picture()), 0);
}

class Displays : public PictureTest {};

TEST_F(Displays, TopAndSideViewShowTheArmAboveEachOther) {
  state_.display = 2;
  const Mask arm = mask(kArm);
  const auto columns = [&](int from, int to) {
    double sum = 0;
    double found = 0;
    for (int y = from; y < to; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (!arm.in[static_cast<std::size_t>(y * kWidth + x)]) continue;
        sum += x;
        found += 1;
      }
    }
    EXPECT_GT(found, 5) << from;
    return sum / found;
  };
  EXPECT_NEAR(columns(0, 90), columns(90, 180), 4.0);
}

TEST_F(Displays, EachShowsTheCellFromWhereItSays) {
  std::vector<Image> seen;
  for (int display = 1; display <= 6; ++display) {
    state_.display = display;
    seen.push_back(picture());
    EXPECT_GT(mask("").count, 800U) << display;
    for (std::size_t other = 0; other + 1 < seen.size(); ++other)
      EXPECT_GT(count_different(seen.back(), seen[other]), 2000) << display << " and " << other + 1;
  }
}

TEST_F(Displays, FullShowsTheLayoutWithoutTitlesAndLegend) {
  const Image normal = picture();
  state_.full_screen = true;
  const Image full = picture();
  EXPECT_GT(count_different(normal, full, {0, 0, 90, 16}), 30) << "the title";
  EXPECT_EQ(count_different(normal, full, {100, 30, 140, 60}), 0) << "the same view";
  state_.display = 2;
  const Mask both = mask(kArm);
  state_.full_screen = false;
  EXPECT_EQ(both.in, mask(kArm).in) << "top and side";
  const Image titled = picture();
  state_.full_screen = true;
  const Image untitled = picture();
  for (const int top : {0, kHeight / 2}) EXPECT_GT(count_different(titled, untitled, {0, top, 90, 16}), 30) << top;
}

class ViewsInPictures : public PictureTest {
 protected:
  // Of the arm: middle, in pixels.
  Eigen::Vector2d middle() {
    const Mask arm = mask(kArm);
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < arm.in.size(); ++i) {
      if (arm.in[i]) sum += Eigen::Vector2d(static_cast<double>(i % kWidth), static_cast<double>(i / kWidth));
    }
    EXPECT_GT(arm.count, 50U);
    return sum / static_cast<double>(arm.count);
  }
  static double height_of(const Mask& mask) {
    int low = kHeight;
    int high = 0;
    for (std::size_t i = 0; i < mask.in.size(); ++i) {
      if (!mask.in[i]) continue;
      low = std::min(low, static_cast<int>(i) / kWidth);
      high = std::max(high, static_cast<int>(i) / kWidth);
    }
    return high - low;
  }
};

TEST_F(ViewsInPictures, TheLookpointIsInTheMiddleAndTwistTurnsAboutIt) {
  scene();
  EXPECT_LE((pixel_of(state_.views[0].view.lookpoint) - Eigen::Vector2i(kWidth / 2, kHeight / 2)).norm(), 1.0);
  const Eigen::Vector2d upright = middle() - Eigen::Vector2d(119.5, 89.5);
  state_.views[0].view.twist = std::numbers::pi;
  const Eigen::Vector2d turned = middle() - Eigen::Vector2d(119.5, 89.5);
  EXPECT_LT((upright + turned).norm(), 1.5);
}

TEST_F(ViewsInPictures, ASmallerViewingAngleShowsItLarger) {
  state_.views[0].view.opening_angle = 1.0;
  const double before = height_of(mask(kArm));
  state_.views[0].view.opening_angle = 2 * std::atan(1.2 * std::tan(0.5));
  EXPECT_NEAR(height_of(mask(kArm)) * 1.2, before, 4.0);
}

TEST_F(ViewsInPictures, ClippingPlanesCutAwayWhatIsBeyondThem) {
  const double distance = (state_.views[0].view.viewpoint - Eigen::Vector3d(2, -1.6, 0.8)).norm();
  state_.views[0].view.far_distance = distance - 0.6;
  EXPECT_EQ(mask(kArm).count, 0U);
  state_.views[0].view.far_distance = distance + 0.6;
  EXPECT_GT(mask(kArm).count, 1500U);
  EXPECT_EQ(mask("Testlab_1").count, 0U) << "the bench behind";
  state_.views[0].view.near_distance = distance + 0.5;
  EXPECT_EQ(mask(kArm).count, 0U);
}

TEST_F(ViewsInPictures, AFarPlaneBeyondTheCellClipsNothingBeforeIt) {
  const std::size_t arm = mask(kArm).count;
  View& view = state_.views[0].view;
  view.near_distance = 0.2;
  view.far_distance = 1e6;  // STVW 0 FCP 200 BCP 1e9
  EXPECT_EQ(mask(kArm).count, arm);
  view.orthogonal = true;
  const std::size_t parallel = mask(kArm).count;
  view.far_distance = 50;
  EXPECT_GT(parallel, 1500U);
  EXPECT_EQ(mask(kArm).count, parallel);
}

TEST_F(ViewsInPictures, ACamerasOwnPyramidIsNotAcrossItsPicture) {
  state_.views[0].camera = state_.cameras[0].name;
  const Image before = picture();
  state_.cameras[0].pyramid = true;
  EXPECT_EQ(count_different(before, picture()), 0);
  state_.cameras[0].tracks = "Mantec_2.J_1";
  const Image tracking = picture();
  state_.cameras[0].pyramid = false;
  EXPECT_EQ(count_different(tracking, picture()), 0);
}

TEST_F(ViewsInPictures, ASequenceBySteps) {
  ViewSequence way;
  way.from = way.to = state_.views[0].view;
  way.to.lookpoint += Eigen::Vector3d(0.6, 0, 0);
  way.to.viewpoint += Eigen::Vector3d(0.6, 0, 0);
  way.steps = 10;
  state_.views[0].sequence = way;
  std::vector<double> x;
  for (updates_ = 0; updates_ <= 10; updates_ += 5) x.push_back(middle().x());
  EXPECT_GT(x[0], x[1] + 5);
  EXPECT_NEAR(x[0] - x[1], x[1] - x[2], 3.0);
}

TEST_F(ViewsInPictures, AViewAtATrackingCameraHasItsTargetInTheMiddle) {
  state_.cameras[0].tracks = "Mantec_2.J_1";
  state_.views[0].camera = state_.cameras[0].name;
  mask(kArm);
  EXPECT_LE((pixel_of(place("Mantec_2.J_1")) - Eigen::Vector2i(kWidth / 2, kHeight / 2)).norm(), 1.0);
}

TEST_F(ViewsInPictures, NoCameraSeesItsOwnHousing) {
  for (const CompiledCamera& camera : cell_->cameras) {
    state_.views[0].camera = camera.name;
    const auto above = static_cast<std::size_t>(cell_->parent[static_cast<std::size_t>(camera.node)]);
    EXPECT_GT(mask("").count, 2000U) << camera.name;
    if (above == 0) continue;  // fixed to the world
    EXPECT_EQ(mask((*cell_->paths)[above]).count, 0U) << camera.name;
  }
}

TEST_F(ViewsInPictures, TheCamerasMainViewFillsTheDisplay) {
  state_.display = 2;
  const Image before = picture();
  set(DisplayMode::camera_main_view);
  const Image after = picture();
  EXPECT_GT(count_different(before, after), 5000);
  state_.current_camera = state_.cameras[1].name;
  EXPECT_GT(count_different(after, picture()), 5000) << "another camera";
}

class Modes : public PictureTest {
 protected:
  // The picture with a mode and without it.
  int effect(DisplayMode mode, const Region& region = kWhole) {
    set(mode, false);
    const Image off = picture();
    set(mode);
    return count_different(off, picture(), region);
  }
};

TEST_F(Modes, WorkframesAsLongAsTagDrawlenSays) {
  scene();
  const Image off = picture();
  set(DisplayMode::workframes);
  state_.tag_length_m = 0.1;
  const int small = count_different(off, picture());
  state_.tag_length_m = 0.4;
  const int large = count_different(off, picture());
  EXPECT_GT(small, 10);
  EXPECT_GT(large, small + 20);
}

TEST_F(Modes, TcpAndZeroPointFrameOfTheActiveRobot) {
  state_.tag_length_m = 0.3;
  const CompiledRobot& robot = *std::ranges::find(cell_->robots, "MANTEC_R3", &CompiledRobot::id);
  q_[robot.slot][1] = -1.2;  // so that the TCP is in the picture
  for (const DisplayMode mode : {DisplayMode::tcp_frame, DisplayMode::zero_point_frame}) {
    input_.active_robot = {};
    EXPECT_EQ(effect(mode), 0);
    input_.active_robot = "MANTEC_R3";
    set(mode, false);
    const Image off = picture();
    set(mode);
    const Image on = picture();
    const Eigen::Vector3d origin = mode == DisplayMode::tcp_frame
                                       ? tcp_poses(robot, poses_).X_WT.translation()
                                       : poses_.X_WN[static_cast<std::size_t>(robot.zero_point)].translation();
    const Region near = around(pixel_of(origin), 40);
    EXPECT_GT(count_different(off, on, near), 60);
    if (mode == DisplayMode::zero_point_frame) continue;  // shines pale through the robot's foot
    for (const auto& colour : {reddish, greenish, bluish})
      EXPECT_GT(count(on, near, colour), count(off, near, colour) + 3);
    set(mode, false);
  }
}

TEST_F(Modes, SmearDrawsWhereTheTcpWas) {
  set(DisplayMode::smear);
  input_.active_robot = "MANTEC_R3";
  const CompiledRobot& robot = *std::ranges::find(cell_->robots, "MANTEC_R3", &CompiledRobot::id);
  q_[robot.slot][1] = -0.5;
  const Image before = picture();
  TcpTrace trace{.robot = "MANTEC_R3", .points = {}, .frames = {}};
  for (int i = 0; i < 20; ++i) {
    q_[robot.slot][0] += 0.05;
    scene();
    trace.points.push_back(tcp_poses(robot, poses_).X_WT.translation().cast<float>());
  }
  input_.traces = std::span(&trace, 1);
  const Eigen::Vector2i halfway = pixel_of(trace.points.at(10).cast<double>());
  q_[robot.slot][0] -= 1.0;
  const Image after = picture();
  EXPECT_GT(count_different(before, after, {halfway.x() - 3, halfway.y() - 3, 7, 7}), 5);
  set(DisplayMode::smear, false);
  EXPECT_EQ(count_different(before, picture(), {halfway.x() - 3, halfway.y() - 3, 7, 7}), 0);
}

TEST_F(Modes, FloorAndShadow) {
  state_.views[0].view.viewpoint = {5.5, -16, 9};
  state_.views[0].view.lookpoint = {5.5, -3, 0};
  set(DisplayMode::shadows);
  const Image none = picture();
  set(DisplayMode::shadows, false);
  EXPECT_EQ(count_different(none, picture()), 0) << "a shadow needs the floor";
  EXPECT_GT(effect(DisplayMode::floor), 4000);
  const Mask cell = mask("");
  const Image floor = picture();
  set(DisplayMode::shadows);
  EXPECT_GT(different(floor, picture(), cell, false) + different(floor, picture(), cell, true), 60U);
}

TEST_F(Modes, TexturesAndAntialiasing) {
  set(DisplayMode::floor);
  state_.views[0].view.viewpoint = {5.5, -16, 9};
  EXPECT_GT(effect(DisplayMode::textures), 500);
  EXPECT_GT(effect(DisplayMode::antialiasing), 300) << "at edges";
}

TEST_F(Modes, TexturesAreOnMeshesToo) {
  show("can_cell");
  EXPECT_GT(effect(DisplayMode::textures), 600) << "without a floor: the stripes of the bench, the scale of the table";
}

TEST_F(Modes, BackfaceRemovalLeavesClosedBodiesAsTheyAreFromOutside) {
  EXPECT_LT(effect(DisplayMode::backface_removal), 40);
  set(DisplayMode::backface_removal, false);
  EXPECT_LT(effect(DisplayMode::cpu_backface_removal), 40);
}

TEST_F(Modes, FromWithinABodyBackfaceRemovalLetsTheEyeOut) {
  scene();
  const CompiledGeometry* wall = nullptr;
  for (const CompiledGeometry& part : cell_->geometry) {
    if (part.geometry->shape == Shape::box && part.geometry->drawn) wall = &part;
  }
  ASSERT_NE(wall, nullptr);
  const Pose X_WG = poses_.X_WN[static_cast<std::size_t>(wall->node)] * wall->geometry->X_NG;
  state_.views[0].view.viewpoint = X_WG.translation();
  state_.views[0].view.lookpoint = X_WG.translation() + Eigen::Vector3d(0.5, -2, 0);
  state_.views[0].view.near_distance = 1e-3;
  EXPECT_GT(effect(DisplayMode::backface_removal), 10000);
  set(DisplayMode::backface_removal, false);
  EXPECT_GT(effect(DisplayMode::two_sided_light), 5000);
}

TEST_F(Modes, TheVisibilityTestSavesWorkAndChangesNothing) {
  const Image all = picture();
  const auto before = renderer()->counters();
  set(DisplayMode::visibility_test);
  EXPECT_EQ(count_different(all, picture()), 0);
  const auto after = renderer()->counters();
  EXPECT_EQ(before.bodies_left_out, 0U);
  EXPECT_GT(after.bodies_left_out, 10U);
  EXPECT_LT(after.bodies_drawn, before.bodies_drawn);
}

class Marks : public PictureTest {
 protected:
  void find_pair(bool touching) {
    proximity_.names = std::make_shared<std::vector<std::string>>(std::vector<std::string>{"Mantec_2.J_1"});
    proximity_.posture_time = input_.now;
    proximity_.warning_distance_m = 0.1;
    scene();
    if (touching) {
      TouchingPair& pair = proximity_.touching.emplace_back();
      pair.a = 0;
      pair.b = 0;
      pair.depth_m = 0.01;
      pair.normal = Eigen::Vector3d::UnitZ();
      pair.point_m = place("Mantec_2.J_1");
    } else {
      NearPair& pair = proximity_.near.emplace_back();
      pair.within_warning = true;
      pair.distance_m = 0.05;
      pair.point_a_m = place("Mantec_2.J_1");
      pair.point_b_m = pair.point_a_m + Eigen::Vector3d(0.5, 0, 0);
    }
    input_.proximity = &proximity_;
  }
  ProximityState proximity_;
};

TEST_F(Marks, AGhostIsPaleAndTellsItsAge) {
  const Mask arm = mask(kArm);
  const Image before = picture();
  const CompiledRobot& robot = *std::ranges::find(cell_->robots, "MANTEC_R3", &CompiledRobot::id);
  const std::vector<RobotCondition> conditions = {{robot.slot, true, DataState::stale, 3.2}};
  input_.robots = conditions;
  const Image after = picture();
  EXPECT_GT(different(before, after, arm, true), arm.count / 2);
  EXPECT_EQ(different(before, after, mask("Testlab_1"), true), 0U) << "nothing else is a ghost";
  const Eigen::Vector2i label = pixel_of(scene_.labels.at(0).at);
  EXPECT_GT(count_different(before, after, {label.x() - 30, std::max(label.y() - 12, 0), 60, 20}), 60);
  EXPECT_GT(count_different(before, after, {0, 120, 80, 60}), 100) << "the legend";
  state_.legend = false;
  EXPECT_LT(count_different(before, picture(), {0, 150, 30, 30}), 20);
}

TEST_F(Marks, NearAndTouchingBodiesAreColoured) {
  const Image before = picture();
  for (const bool touching : {false, true}) {
    proximity_ = {};
    find_pair(touching);
    const Image after = picture();
    const Mask part = mask("Mantec_2.J_1");
    EXPECT_GT(different(before, after, part, true), 100U) << touching;
    std::size_t marked = 0;
    for (const SceneBody& body : scene_.bodies) marked += body.mark == Mark::none ? 0U : 1U;
    EXPECT_GT(marked, 0U);
  }
}

TEST_F(Marks, PyramidConeArrowSparkAndMessage) {
  const Image before = picture();
  scene();
  const Eigen::Vector3d hand = place("Mantec_2.J_1");
  std::vector<RangeReading> readings(1);
  readings[0].id = "USS";
  readings[0].range_m = 1;
  readings[0].half_angle_rad = 0.3;
  readings[0].X_WS.translation() = hand + Eigen::Vector3d(0.4, 0, 0);
  input_.ranges = readings;
  EXPECT_GT(count_different(before, picture(), around(pixel_of(hand + Eigen::Vector3d(0.4, 0, 0.5)), 12)), 60);
  input_.ranges = {};
  const std::vector<ForceArrow> arrows = {{hand, {40, 0, 0}, false}};
  input_.arrows = arrows;
  const Image arrow = picture();
  EXPECT_GT(count(arrow, kWhole, greenish), count(before, kWhole, greenish) + 10);
  const std::vector<ForceArrow> within = {{hand, {0, 0, 40}, false}};
  input_.arrows = within;
  EXPECT_GT(different(before, picture(), mask("Mantec_2.J_1"), true), 30U) << "shines through its link";
  input_.arrows = {};
  state_.arcs = {"MANTEC_R3"};
  const CompiledRobot& robot = *std::ranges::find(cell_->robots, "MANTEC_R3", &CompiledRobot::id);
  EXPECT_GT(count_different(before, picture(), around(pixel_of(tcp_poses(robot, poses_).X_WT.translation()), 6)), 20);
  state_.arcs.clear();
  state_.messages = {{"hello", input_.now, 1}};
  EXPECT_GT(count_different(before, picture(), {90, 0, 60, 40}), 200);
  state_.messages.clear();
  state_.display = 6;
  const Image overview = picture();
  state_.cameras[0].pyramid = true;
  EXPECT_GT(count_different(overview, picture()), 60);
}

}  // namespace
}  // namespace cellmirror::scene
