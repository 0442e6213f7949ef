// Bodies and their draw modes, frames, traces, cameras, sparks, messages and the floor, out of a cell and what SCRIPT
// has set.
#include "rt_core/scene/scene_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "rt_core/ports/palette.hpp"
#include "rt_core/scene/draw_rules.hpp"
#include "tests/unit/scene/small_cell.hpp"

namespace cellmirror::scene {
namespace {

class BuilderTest : public ::testing::Test {
 protected:
  const Scene& build() {
    input_.cell = &cell_.cell;
    input_.poses = &cell_.poses;
    input_.display = &cell_.display;
    sut_.build(input_, scene_);
    return scene_;
  }
  void set(DisplayMode mode, bool on = true) { cell_.display.modes.set(static_cast<std::size_t>(mode), on); }
  DrawMode mode_of(SmallCell::Node node) { return build().bodies[cell_.body_of(node)].mode; }
  void changed() { ++cell_.cell.revision; }

  SmallCell cell_;
  SceneInput input_ = [] {
    SceneInput input;
    input.posture_time = Timestamp{1};
    input.now = Timestamp{10'000'000'000};
    return input;
  }();
  Scene scene_;
  SceneBuilder sut_;
};

TEST_F(BuilderTest, ABodyLiesWhereItsNodeIsAndTellsWhichItIs) {
  cell_.pose(0.5 * std::numbers::pi);
  const SceneBody& hand = build().bodies[cell_.body_of(SmallCell::hand)];
  EXPECT_LT((hand.X_WG.translation() - Eigen::Vector3d(0, 1, 0.4)).norm(), 1e-12);
  EXPECT_EQ(hand.object, SmallCell::hand + 1U);
  EXPECT_EQ(hand.size, Eigen::Vector3d(0.2, 0.4, 0.6));
  EXPECT_EQ(hand.mark, Mark::none);
  cell_.pose(0);
  EXPECT_LT((build().bodies[cell_.body_of(SmallCell::hand)].X_WG.translation() - Eigen::Vector3d(1, 0, 0.4)).norm(),
            1e-12);
}

TEST_F(BuilderTest, WhatIsNotDrawnIsLeftOut) {
  auto geometry = std::make_shared<Geometry>(*cell_.cell.geometry[0].geometry);
  geometry->drawn = false;
  cell_.cell.geometry[0].geometry = geometry;
  EXPECT_EQ(build().bodies.size(), 3U);
}

TEST_F(BuilderTest, ACellThatChangedIsDrawnAsItIsNow) {
  build();
  cell_.cell.geometry.erase(cell_.cell.geometry.begin());
  changed();
  EXPECT_EQ(build().bodies.size(), 3U);
}

TEST_F(BuilderTest, AFramesRuleIsForItsOwnGeometryAlone) {
  cell_.display.draw_rules = {{"Arm", false, DrawMode::wireframe}};
  EXPECT_EQ(mode_of(SmallCell::arm), DrawMode::wireframe);
  EXPECT_EQ(mode_of(SmallCell::hand), DrawMode::gouraud);
}

TEST_F(BuilderTest, ABranchRuleIsForEverythingBelowInTheTreeOfNames) {
  cell_.display.draw_rules = {{"Arm", true, DrawMode::transparent}};
  EXPECT_EQ(mode_of(SmallCell::arm), DrawMode::transparent);
  EXPECT_EQ(mode_of(SmallCell::hand), DrawMode::transparent);
  EXPECT_EQ(mode_of(SmallCell::tool), DrawMode::gouraud) << "in the hand, but named elsewhere";
  EXPECT_EQ(mode_of(SmallCell::table), DrawMode::gouraud);
}

TEST_F(BuilderTest, TheLastRuleCounts) {
  cell_.display.draw_rules = {{"Arm.J_1.Hand", false, DrawMode::flat}, {"Arm", true, DrawMode::wireframe}};
  EXPECT_EQ(mode_of(SmallCell::hand), DrawMode::wireframe);
  cell_.display.draw_rules.push_back({"Arm.J_1.Hand", false, DrawMode::flat});
  EXPECT_EQ(mode_of(SmallCell::hand), DrawMode::flat);
  EXPECT_EQ(mode_of(SmallCell::arm), DrawMode::wireframe);
}

TEST_F(BuilderTest, ARuleWaitsForWhatIsLoadedLater) {
  cell_.display.draw_rules = {{"Arm.J_1", true, DrawMode::flat}, {"Nowhere.At.All", false, DrawMode::flat}};
  cell_.cell.geometry.erase(cell_.cell.geometry.begin() + 2);  // the hand's
  build();
  SmallCell whole;
  cell_.cell.geometry = whole.cell.geometry;
  changed();
  EXPECT_EQ(mode_of(SmallCell::hand), DrawMode::flat);
}

TEST(DrawRule, APathIsNoPathsBeginningButAtADot) {
  EXPECT_TRUE(covers({"Arm", true, DrawMode::flat}, "Arm.J_1"));
  EXPECT_FALSE(covers({"Arm", true, DrawMode::flat}, "Arm_2"));
  EXPECT_FALSE(covers({"Arm", false, DrawMode::flat}, "Arm.J_1"));
  EXPECT_TRUE(covers({"", true, DrawMode::flat}, "Arm")) << "the world is the branch of everything";
}

TEST_F(BuilderTest, WorkframesAreThoseOfCamerasAndSensorsToo) {
  EXPECT_TRUE(build().axes.empty());
  set(DisplayMode::workframes);
  cell_.display.tag_length_m = 0.05;
  std::vector<std::string> names;
  for (const SceneAxes& axes : build().axes) {
    names.push_back(axes.name);
    EXPECT_EQ(axes.length_m, 0.05);
    EXPECT_FALSE(axes.emphasized);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"Tag", "CAM", "USS"}));
  cell_.cell.visible[SmallCell::tag] = 0;
  EXPECT_EQ(build().axes.size(), 2U);
}

TEST_F(BuilderTest, FramesOfTheActiveRobotAlone) {
  set(DisplayMode::tcp_frame);
  set(DisplayMode::zero_point_frame);
  EXPECT_TRUE(build().axes.empty());
  input_.active_robot = "ARM";
  const auto& axes = build().axes;
  ASSERT_EQ(axes.size(), 2U);
  EXPECT_LT((axes[0].X_WF.translation() - Eigen::Vector3d(1, 0, 0.5)).norm(), 1e-12);
  EXPECT_EQ(axes[0].name, "ARM TCP");
  EXPECT_TRUE(axes[0].emphasized);
  EXPECT_EQ(axes[1].X_WF.translation(), Eigen::Vector3d::Zero());
}

TEST_F(BuilderTest, TracesAreDrawnWhileTheModeIsOn) {
  const std::vector<TcpTrace> traces{{.robot = "ARM", .points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, .frames = {}},
                                     {.robot = "ARM", .points = {{0, 0, 0}}, .frames = {}},
                                     {.robot = "GONE", .points = {{0, 0, 0}, {1, 0, 0}}, .frames = {}}};
  input_.traces = traces;
  EXPECT_TRUE(build().traces.empty());
  set(DisplayMode::smear);
  ASSERT_EQ(build().traces.size(), 1U) << "one point is no curve, and a robot that was deleted has none";
  EXPECT_EQ(scene_.traces[0].points, traces[0].points);
}

TEST_F(BuilderTest, TracesShowTheOrientationOfTheTcpWhereItsFrameIsDrawn) {
  Pose X_WT = Pose::Identity();
  X_WT.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()));
  const std::vector<TcpTrace> traces{{.robot = "ARM", .points = {{0, 0, 0}}, .frames = {Pose::Identity(), X_WT}}};
  input_.traces = traces;
  set(DisplayMode::smear);
  EXPECT_TRUE(build().axes.empty());
  set(DisplayMode::tcp_frame);
  ASSERT_EQ(build().axes.size(), 2U);
  EXPECT_TRUE(scene_.axes[1].X_WF.isApprox(X_WT));
  EXPECT_LT(scene_.axes[1].length_m, cell_.display.tag_length_m);
  EXPECT_TRUE(scene_.axes[1].name.empty());
  set(DisplayMode::smear, false);
  EXPECT_TRUE(build().axes.empty());
}

TEST_F(BuilderTest, APyramidReachesToTheViewingDistance) {
  cell_.display.cameras.resize(1);
  cell_.display.cameras[0].name = "CAM";
  cell_.display.cameras[0].pyramid = true;
  const Eigen::Vector3d apex(2, 0, 1.5);
  double farthest = 0;
  std::size_t from_apex = 0;
  for (const SceneLine& line : build().lines) {
    from_apex += line.from == apex ? 1U : 0U;
    farthest = std::max(farthest, (line.to - apex).z());
    EXPECT_EQ(line.camera, SmallCell::camera + 1U) << "it is not drawn across the camera's own picture";
  }
  EXPECT_EQ(from_apex, 4U);
  EXPECT_NEAR(farthest, 2.0, 1e-12);
  ASSERT_EQ(scene_.labels.size(), 1U);
  EXPECT_EQ(scene_.labels[0].text, "CAM");
  EXPECT_EQ(scene_.labels[0].camera, SmallCell::camera + 1U);
  cell_.display.cameras[0].pyramid = false;
  EXPECT_TRUE(build().lines.empty());
}

TEST_F(BuilderTest, AnArcSparksAtTheTcp) {
  cell_.display.arcs = {"ARM", "gone"};
  ASSERT_EQ(build().sparks.size(), 1U);
  EXPECT_LT((scene_.sparks[0].at - Eigen::Vector3d(1, 0, 0.5)).norm(), 1e-12);
  const std::uint32_t phase = scene_.sparks[0].phase;
  input_.now = input_.now + std::chrono::milliseconds(40);
  EXPECT_EQ(build().sparks[0].phase, phase + 1);
}

TEST_F(BuilderTest, AMessageIsShownForFiveSeconds) {
  cell_.display.messages = {{"old", Timestamp{4'900'000'000}, 1}, {"new", Timestamp{5'100'000'000}, 2}};
  EXPECT_EQ(build().messages, std::vector<std::string>{"new"});
}

TEST_F(BuilderTest, TheFloorLiesUnderWhatStandsAndReachesAsFarAsTheCell) {
  build();
  EXPECT_NEAR(scene_.floor_z_m, -0.3, 1e-12) << "the arm's box";
  EXPECT_LE(scene_.floor_low.x(), -0.1);
  EXPECT_GE(scene_.floor_high.x(), 2.1);
  const double before = scene_.floor_high.y();
  cell_.pose(0.5 * std::numbers::pi);
  EXPECT_GT(build().floor_high.y(), before) << "it grows with what moves";
  const double grown = scene_.floor_high.y();
  cell_.pose(0);
  EXPECT_EQ(build().floor_high.y(), grown) << "and does not shrink again";
}

TEST_F(BuilderTest, ASlabUnderEverythingCatchesShadowsAndCastsNone) {
  EXPECT_TRUE(build().shadow_catchers.empty());
  auto slab = std::make_shared<Geometry>();
  slab->shape = Shape::box;
  slab->size = {3, 2, 0.1};
  slab->X_NG.translation() << 0, 0, -0.85;
  cell_.cell.geometry[0].geometry = slab;  // the table's
  changed();
  ASSERT_EQ(build().shadow_catchers.size(), 1U);
  EXPECT_NEAR(scene_.floor_z_m, -0.4, 1e-12);
  EXPECT_NEAR(scene_.shadow_catchers[0].z_m, -0.3, 1e-12);
  EXPECT_LT((scene_.shadow_catchers[0].low - Eigen::Vector2d(0.5, -1)).norm(), 1e-12);
  EXPECT_FALSE(scene_.bodies[cell_.body_of(SmallCell::table)].casts_shadow);
  EXPECT_TRUE(scene_.bodies[cell_.body_of(SmallCell::arm)].casts_shadow);
}

TEST_F(BuilderTest, PaintOnASlabCastsNoShadow) {
  for (const double above : {0.001, 0.05}) {
    auto slab = std::make_shared<Geometry>();
    slab->shape = Shape::box;
    slab->size = {3, 2, 0.1};
    slab->X_NG.translation() << 0, 0, -0.85;
    auto sheet = std::make_shared<Geometry>(*slab);
    sheet->size = {1, 1, 0.001};
    sheet->X_NG.translation() << 0, 0, -0.80 + above;
    cell_.cell.geometry[0].geometry = slab;
    if (above < 0.01) cell_.cell.geometry.insert(cell_.cell.geometry.begin(), cell_.cell.geometry[0]);
    cell_.cell.geometry[0].geometry = sheet;
    cell_.cell.geometry[1].geometry = slab;
    changed();
    EXPECT_EQ(build().bodies.at(0).casts_shadow, above > 0.01) << "a sheet in the air does";
    EXPECT_FALSE(scene_.bodies.at(1).casts_shadow);
  }
}

TEST_F(BuilderTest, AnActiveSensorWithoutReadingShowsItsRange) {
  EXPECT_TRUE(build().cones.empty());
  cell_.cell.sensors[0].sensor.active = true;
  ASSERT_EQ(build().cones.size(), 1U);
  EXPECT_EQ(scene_.cones[0].length_m, 1.5);
  EXPECT_EQ(scene_.cones[0].half_angle_rad, 0.2);
}

TEST_F(BuilderTest, AReadingEndsTheConeAtTheSurface) {
  cell_.cell.sensors[0].sensor.active = true;
  std::vector<RangeReading> readings(1);
  readings[0].id = "USS";
  readings[0].path = "Table.USS";
  readings[0].range_m = 1.5;
  readings[0].distance_m = 0.8;
  readings[0].point_m = {0, 0, 0.8};
  readings[0].half_angle_rad = 0.2;
  input_.ranges = readings;
  ASSERT_EQ(build().cones.size(), 1U);
  EXPECT_EQ(scene_.cones[0].length_m, 0.8);
  ASSERT_EQ(scene_.lines.size(), 1U);
  EXPECT_EQ(scene_.lines[0].to, Eigen::Vector3d(0, 0, 0.8));
  EXPECT_EQ(scene_.labels.at(0).text, "USS 800 mm");
  readings[0].distance_m.reset();
  EXPECT_EQ(build().cones.at(0).length_m, 1.5);
  EXPECT_EQ(scene_.labels.at(0).text, "USS > 1.50 m");
  EXPECT_TRUE(scene_.lines.empty());
}

TEST_F(BuilderTest, ALightBarrierIsALineWithItsState) {
  std::vector<BarrierReading> barriers(2);
  barriers[0].name = "gate";
  barriers[0].placed = true;
  barriers[0].from = {0, 0, 1};
  barriers[0].to = {0, 2, 1};
  barriers[1].name = "lost";
  input_.barriers = barriers;
  ASSERT_EQ(build().lines.size(), 1U) << "a beam whose ends are not known is not drawn";
  EXPECT_EQ(scene_.lines[0].from, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(scene_.lines[0].to, Eigen::Vector3d(0, 2, 1));
  EXPECT_EQ(scene_.lines[0].rgba, palette::kBeam);
  EXPECT_EQ(scene_.labels.at(0).text, "gate");
  barriers[0].interrupted = true;
  barriers[0].object = "Cell.Arm.hand";
  barriers[0].short_object = "Arm.hand";
  barriers[0].doubtful = true;
  EXPECT_EQ(build().lines.at(0).rgba, palette::kBeamInterrupted);
  EXPECT_TRUE(scene_.lines[0].dashed);
  EXPECT_EQ(scene_.labels.at(0).text, "gate interrupted: Arm.hand, doubtful");
}

}  // namespace
}  // namespace cellmirror::scene
