// Ghosts, near and touching pairs, arrows of forces, and the legend that explains them.
#include <gtest/gtest.h>

#include <algorithm>

#include "rt_core/ports/palette.hpp"
#include "rt_core/scene/force_arrows.hpp"
#include "rt_core/scene/scene_builder.hpp"
#include "rt_core/scene/words.hpp"
#include "tests/unit/scene/small_cell.hpp"

namespace cellmirror::scene {
namespace {

class MarksTest : public ::testing::Test {
 protected:
  MarksTest() {
    proximity_.names = std::make_shared<std::vector<std::string>>(
        std::vector<std::string>{"Arm.J_1.Hand", "Table", "Tool", "not in the cell"});
    proximity_.posture_time = input_.now;
    proximity_.warning_distance_m = 0.1;
  }
  const Scene& build() {
    input_.cell = &cell_.cell;
    input_.poses = &cell_.poses;
    input_.display = &cell_.display;
    input_.robots = robots_;
    input_.proximity = &proximity_;
    input_.arrows = arrows_;
    sut_.build(input_, scene_);
    return scene_;
  }
  void condition(DataState state, double age_s, bool mirrored = true) { robots_ = {{0, mirrored, state, age_s}}; }
  Mark mark_of(SmallCell::Node node) { return build().bodies[cell_.body_of(node)].mark; }
  [[nodiscard]] bool legend_has(const std::string& text) const {
    return std::ranges::any_of(scene_.legend, [&](const LegendEntry& entry) { return entry.text == text; });
  }
  static NearPair near_pair() {
    NearPair pair;
    pair.a = 0;
    pair.b = 1;
    pair.distance_m = 0.034;
    pair.point_a_m = {1, 0, 0};
    pair.point_b_m = {1, 0.034, 0};
    pair.within_warning = true;
    return pair;
  }
  static TouchingPair touching_pair() {
    TouchingPair pair;
    pair.a = 0;
    pair.b = 1;
    pair.depth_m = 0.012;
    pair.point_m = {1, 2, 3};
    pair.normal = Eigen::Vector3d::UnitX();
    return pair;
  }

  SmallCell cell_;
  SceneInput input_ = [] {
    SceneInput input;
    input.posture_time = Timestamp{1};
    input.now = Timestamp{10'000'000'000};
    return input;
  }();
  std::vector<RobotCondition> robots_;
  ProximityState proximity_;
  std::vector<ForceArrow> arrows_;
  Scene scene_;
  SceneBuilder sut_;
};

TEST_F(MarksTest, AMirroredRobotWithOldDataIsAGhostWithAllItCarries) {
  condition(DataState::stale, 3.21);
  EXPECT_EQ(mark_of(SmallCell::arm), Mark::ghost);
  EXPECT_EQ(mark_of(SmallCell::hand), Mark::ghost);
  EXPECT_EQ(mark_of(SmallCell::tool), Mark::ghost);
  EXPECT_EQ(mark_of(SmallCell::table), Mark::none);
  ASSERT_EQ(scene_.labels.size(), 1U);
  EXPECT_EQ(scene_.labels[0].text, "ARM: stale 3.2 s");
  EXPECT_EQ(scene_.labels[0].mark, Mark::ghost);
  EXPECT_GT(scene_.labels[0].at.z(), 0.7) << "above the robot";
  EXPECT_TRUE(legend_has("old data"));
}

TEST_F(MarksTest, EveryStateButFreshMakesAGhost) {
  condition(DataState::fresh, 0.01);
  EXPECT_EQ(mark_of(SmallCell::arm), Mark::none);
  EXPECT_TRUE(scene_.labels.empty());
  condition(DataState::lost, 75);
  EXPECT_EQ(mark_of(SmallCell::arm), Mark::ghost);
  EXPECT_EQ(scene_.labels.at(0).text, "ARM: lost 75 s");
  condition(DataState::invalid, 0.2);
  EXPECT_EQ(mark_of(SmallCell::arm), Mark::ghost);
  condition(DataState::none, 0);
  EXPECT_EQ(mark_of(SmallCell::arm), Mark::ghost);
  EXPECT_EQ(scene_.labels.at(0).text, "ARM: no data");
}

TEST_F(MarksTest, ARobotThatIsNotMirroredIsNoGhost) {
  condition(DataState::none, 0, false);
  EXPECT_EQ(mark_of(SmallCell::arm), Mark::none);
}

TEST_F(MarksTest, ANearPairIsJoinedByItsNearestPoints) {
  proximity_.near = {near_pair()};
  EXPECT_EQ(mark_of(SmallCell::hand), Mark::near);
  EXPECT_EQ(mark_of(SmallCell::table), Mark::near);
  EXPECT_EQ(mark_of(SmallCell::arm), Mark::none);
  ASSERT_EQ(scene_.lines.size(), 1U);
  EXPECT_EQ(scene_.lines[0].from, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(scene_.lines[0].to, Eigen::Vector3d(1, 0.034, 0));
  EXPECT_TRUE(scene_.lines[0].on_top);
  EXPECT_EQ(scene_.labels.at(0).text, "34 mm");
  EXPECT_TRUE(legend_has("nearer than 100 mm"));
}

TEST_F(MarksTest, TheCellsOwnGeometryIsMarkedByTheCellsName) {
  cell_.cell.name = "bench";
  cell_.add_box(SmallCell::world);
  proximity_.names = std::make_shared<std::vector<std::string>>(std::vector<std::string>{"Arm.J_1.Hand", "bench"});
  proximity_.near = {near_pair()};
  EXPECT_EQ(mark_of(SmallCell::world), Mark::near);
  EXPECT_EQ(mark_of(SmallCell::hand), Mark::near);
}

TEST_F(MarksTest, APairBeyondTheWarningDistanceIsLeftAlone) {
  proximity_.near = {near_pair()};
  proximity_.near[0].within_warning = false;
  EXPECT_EQ(mark_of(SmallCell::hand), Mark::none);
  EXPECT_TRUE(scene_.lines.empty());
  EXPECT_TRUE(scene_.legend.empty());
}

TEST_F(MarksTest, MarksGoWhenThePairParts) {
  proximity_.near = {near_pair()};
  build();
  proximity_.near.clear();
  EXPECT_EQ(mark_of(SmallCell::hand), Mark::none);
}

TEST_F(MarksTest, TouchingWinsOverNearAndGhost) {
  condition(DataState::stale, 1);
  proximity_.near = {near_pair()};
  proximity_.touching = {touching_pair()};
  EXPECT_EQ(mark_of(SmallCell::hand), Mark::touching);
  EXPECT_EQ(mark_of(SmallCell::arm), Mark::ghost);
  const auto label = std::ranges::find(scene_.labels, Mark::touching, &SceneLabel::mark);
  ASSERT_NE(label, scene_.labels.end());
  EXPECT_EQ(label->text, "touching 12 mm deep");
  EXPECT_EQ(label->at, Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(legend_has("touching"));
}

// A floor and a wall are one body of many a cell.
TEST_F(MarksTest, OnlyTheGeometryThatTouchesIsMarked) {
  auto wall = std::make_shared<Geometry>(*cell_.cell.geometry.at(0).geometry);
  wall->X_NG.translation().x() = 1.0;
  cell_.cell.geometry.insert(cell_.cell.geometry.begin() + 1, {SmallCell::table, wall});
  proximity_.names = std::make_shared<const std::vector<std::string>>(std::vector<std::string>{"Table", "Arm"});
  proximity_.touching = {touching_pair()};
  TouchingPair& pair = proximity_.touching[0];
  pair.point_m = {3.0, 0.1, 0.5};  // in the wall; the table is at 2.0
  const auto& bodies = build().bodies;
  EXPECT_EQ(bodies.at(0).mark, Mark::none);
  EXPECT_EQ(bodies.at(1).mark, Mark::touching);
  EXPECT_EQ(bodies.at(2).mark, Mark::touching) << "the arm has one geometry, wherever the point is";
  pair.points = {{.point_m = {2.0, 0, 0.5}}};
  EXPECT_EQ(build().bodies.at(0).mark, Mark::touching) << "each point of a contact counts";
  EXPECT_EQ(scene_.bodies.at(1).mark, Mark::touching);
  proximity_.touching.clear();
  proximity_.near = {near_pair()};
  proximity_.near[0].point_a_m = {2.1, 0, 0.5};
  EXPECT_EQ(build().bodies.at(0).mark, Mark::near);
  EXPECT_EQ(scene_.bodies.at(1).mark, Mark::none);
}

TEST_F(MarksTest, DoubtAndAgeAreTold) {
  proximity_.near = {near_pair()};
  proximity_.near[0].doubtful = true;
  proximity_.posture_time = input_.now - std::chrono::seconds(2);
  build();
  EXPECT_TRUE(scene_.lines.at(0).dashed);
  EXPECT_EQ(scene_.labels.at(0).text, "at least 34 mm (2.0 s ago)");
}

TEST_F(MarksTest, NamesThatTheCellDoesNotHaveAreNoTrouble) {
  proximity_.near = {near_pair()};
  proximity_.near[0].a = 3;
  proximity_.near[0].b = 77;
  build();
  for (const SceneBody& body : scene_.bodies) EXPECT_EQ(body.mark, Mark::none);
}

TEST_F(MarksTest, ManyPairsStayBounded) {
  proximity_.near.assign(5000, near_pair());
  proximity_.touching.assign(5000, touching_pair());
  build();
  EXPECT_LE(scene_.lines.size(), 400U);
  EXPECT_LE(scene_.labels.size(), 24U);
}

TEST_F(MarksTest, ArrowsAreAsLongAsTheLegendSays) {
  arrows_ = {{{1, 0, 0}, {0, 0, 30}, false}, {{1, 0, 0}, {0, 12, 0}, false}, {{0, 0, 0}, {4, 0, 0}, true}};
  build();
  ASSERT_EQ(scene_.arrows.size(), 3U);
  EXPECT_NEAR(scene_.arrows[1].along.norm() / scene_.arrows[0].along.norm(), 0.4, 1e-12);
  EXPECT_LT(scene_.arrows[0].along.norm(), 1.0);
  EXPECT_GT(scene_.arrows[0].along.norm(), 0.05);
  EXPECT_TRUE(scene_.arrows[2].torque);
  const double newton_per_metre = 30 / scene_.arrows[0].along.norm();
  const double nm_per_metre = 4 / scene_.arrows[2].along.norm();
  EXPECT_TRUE(legend_has("force, 100 mm = " + quantity_text(0.1 * newton_per_metre, "N")));
  EXPECT_TRUE(legend_has("torque, 100 mm = " + quantity_text(0.1 * nm_per_metre, "Nm")));
}

TEST_F(MarksTest, AJointBeyondItsLimitIsLabelled) {
  ForceState forces;
  RobotForces& robot = forces.robots.emplace_back();
  robot.id = "ARM";
  JointForce& joint = robot.joints.emplace_back();
  joint.name = "J_1";
  joint.effort = 123.456;
  joint.max_effort = 100;
  input_.forces = &forces;
  EXPECT_TRUE(build().labels.empty());
  joint.beyond_limit = true;
  joint.X_WJ.translation() << 1, 2, 3;
  ASSERT_EQ(build().labels.size(), 1U);
  EXPECT_EQ(scene_.labels[0].text, "ARM J_1: 123.5 Nm, beyond its 100 Nm");
  EXPECT_EQ(scene_.labels[0].at, Eigen::Vector3d(1, 2, 3));
}

TEST(ArrowScale, IsARoundNumberAndDoesNotFlutter) {
  ArrowScale sut;
  EXPECT_EQ(sut.update(0, 0.5), 0);
  EXPECT_EQ(sut.update(30, 0.5), 100);
  EXPECT_EQ(sut.update(45, 0.5), 100);
  EXPECT_EQ(sut.update(12, 0.5), 100) << "a little smaller";
  EXPECT_EQ(sut.update(51, 0.5), 200);
  EXPECT_EQ(sut.update(49, 0.5), 200) << "back across the border";
  EXPECT_EQ(sut.update(5, 0.5), 10);
  EXPECT_EQ(sut.update(0.0012, 1), 0.002);
}

TEST_F(MarksTest, TheLegendCanBeSwitchedOffAndIsNotInFullScreen) {
  proximity_.touching = {touching_pair()};
  EXPECT_FALSE(build().legend.empty());
  cell_.display.legend = false;
  EXPECT_TRUE(build().legend.empty());
  cell_.display.legend = true;
  cell_.display.full_screen = true;
  EXPECT_TRUE(build().legend.empty());
}

TEST(Words, QuantitiesHaveAUnitThatFits) {
  EXPECT_EQ(distance_text(0.0344), "34 mm");
  EXPECT_EQ(distance_text(0.9996), "1.00 m");
  EXPECT_EQ(distance_text(12.345), "12.35 m");
  EXPECT_EQ(age_text(0.04), "0.0 s");
  EXPECT_EQ(age_text(59.6), "60 s");
  EXPECT_EQ(age_text(600), "10 min");
  EXPECT_EQ(age_text(7200), "2 h");
  EXPECT_EQ(quantity_text(0.2, "N"), "0.2 N");
  EXPECT_EQ(quantity_text(5000, "N"), "5 kN");
  EXPECT_EQ(quantity_text(0.005, "Nm"), "5 mNm");
}

}  // namespace
}  // namespace cellmirror::scene
