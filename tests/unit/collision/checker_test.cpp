// What the checker finds, tells once, and doubts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "tests/unit/collision/cell_of_bodies.hpp"

namespace cellmirror::collision {
namespace {

// A ball of radius 0.1 that moves along x, and walls: the nearest face is at x = 1.
constexpr const char* kTrack = R"(
[[node]]
name = "Sledge"
abstract = "sledge.mpc"
[[node]]
name = "Wall"
xyz_m = [1.5, 0.0, 0.0]
geometry = [{ name = "wall", box_m = [1.0, 4.0, 4.0] }]
)";

struct CheckerTest : CellOfBodies {
  void track() {
    build(kTrack);
    adopt();
  }
  const ProximityState& at(double x) {
    joint("SLEDGE", 0) = x;
    return check();
  }
  // E.g. "entered_warning touched".
  static std::string told(const ProximityState& findings) {
    constexpr std::array kNames{"entered_warning", "touched", "parted", "left_warning"};
    std::string text;
    for (const ProximityEvent& event : findings.events)
      text += std::string(text.empty() ? "" : " ") + kNames[static_cast<std::size_t>(event.change)];
    return text;
  }
};

TEST_F(CheckerTest, TellsTheNearestPairHoweverFar) {
  track();
  const ProximityState& findings = at(-4.0);
  EXPECT_EQ(findings.pairs, 1U);
  EXPECT_TRUE(findings.touching.empty());
  ASSERT_EQ(findings.near.size(), 1U);
  EXPECT_NEAR(findings.nearest()->distance_m, 4.9, 1e-12);
  EXPECT_FALSE(findings.nearest()->within_warning);
  EXPECT_FALSE(findings.nearest()->doubtful);
  const bool ball_first = (*findings.names)[findings.near[0].a] == "Sledge.X";
  const Eigen::Vector3d p_ball = ball_first ? findings.near[0].point_a_m : findings.near[0].point_b_m;
  const Eigen::Vector3d p_wall = ball_first ? findings.near[0].point_b_m : findings.near[0].point_a_m;
  EXPECT_NEAR(p_ball.x(), -3.9, 1e-12);
  EXPECT_NEAR(p_wall.x(), 1.0, 1e-12);
  EXPECT_EQ(findings.posture_time.ns, 1);
}

TEST_F(CheckerTest, TellsDepthAndPlaceOfATouch) {
  track();
  const ProximityState& findings = at(0.95);
  ASSERT_EQ(findings.touching.size(), 1U);
  const TouchingPair& touching = findings.touching[0];
  EXPECT_LT(touching.a, touching.b);
  EXPECT_NEAR(touching.depth_m, 0.05, 1e-9);
  EXPECT_NEAR(std::abs(touching.normal.x()), 1.0, 1e-9);
  EXPECT_NEAR(touching.point_m.x(), 1.025, 1e-9);
  EXPECT_FALSE(touching.doubtful);
  ASSERT_EQ(findings.near.size(), 1U);
  EXPECT_EQ(findings.nearest()->distance_m, 0.0);
  EXPECT_TRUE(findings.nearest()->within_warning);
  EXPECT_TRUE(findings.doubts.empty());
}

TEST_F(CheckerTest, TakesTurnsWithContactsWhereTheyAreLimited) {
  build(std::string(kTrack) +
        "[[node]]\nname = \"Pillar\"\nxyz_m = [1.5, 1.0, 0.0]\n"
        "geometry = [{ name = \"pillar\", box_m = [1.0, 4.0, 4.0] }]\n");
  adopt();
  sut.limit_contacts(1);
  for (const TouchingPair& touching : at(0.95).touching) EXPECT_NEAR(touching.depth_m, 0.05, 1e-9);
  const auto depths = [&](double x) {
    std::vector<double> sorted;
    for (const TouchingPair& touching : at(x).touching) sorted.push_back(touching.depth_m);
    std::ranges::sort(sorted);
    return sorted;
  };
  const auto one_anew = depths(0.96);
  ASSERT_EQ(one_anew.size(), 2U);
  EXPECT_NEAR(one_anew[0], 0.05, 1e-9);
  EXPECT_NEAR(one_anew[1], 0.06, 1e-9);
  const auto the_other = depths(0.97);
  EXPECT_NEAR(the_other[0], 0.06, 1e-9);
  EXPECT_NEAR(the_other[1], 0.07, 1e-9);
  EXPECT_TRUE(at(0.5).touching.empty());
  for (const TouchingPair& touching : at(0.98).touching) EXPECT_NEAR(touching.depth_m, 0.08, 1e-9);
}

TEST_F(CheckerTest, NoiseAtTheWarningDistanceGivesOneEventOnly) {
  track();
  EXPECT_EQ(told(at(0.8501)), "entered_warning");
  for (int i = 0; i < 20; ++i) EXPECT_EQ(told(at(0.85 + (i % 2 == 0 ? -3e-4 : 3e-4))), "");
  EXPECT_EQ(told(at(0.849)), "left_warning");
}

TEST_F(CheckerTest, PairThatHasNotLeftTheWarningDistanceIsToldWithinIt) {
  track();
  EXPECT_TRUE(at(0.851).nearest()->within_warning);
  const ProximityState& findings = at(0.8497);
  EXPECT_GT(findings.nearest()->distance_m, findings.warning_distance_m);
  EXPECT_TRUE(findings.nearest()->within_warning);
  EXPECT_FALSE(at(0.849).nearest()->within_warning);
}

TEST_F(CheckerTest, ContactsTellOfWhichPostureTheyAre) {
  track();
  sut.limit_contacts(1, 3);
  std::map<std::int64_t, double> depths;  // by the time of the posture
  for (int i = 0; i < 12; ++i) {
    const double x = 0.95 + 0.001 * i;
    const ProximityState& findings = at(x);
    depths[findings.posture_time.ns] = x - 0.9;
    const TouchingPair& touching = findings.touching.at(0);
    ASSERT_TRUE(depths.contains(touching.contact_time.ns));
    EXPECT_NEAR(touching.depth_m, depths[touching.contact_time.ns], 1e-9);
  }
}

TEST_F(CheckerTest, RefreshesContactsInEveryPeriodThPostureOnly) {
  track();
  sut.limit_contacts(1, 3);
  EXPECT_NEAR(at(0.95).touching.at(0).depth_m, 0.05, 1e-9);
  int refreshed = 0;
  double before = 0.05;
  for (int i = 1; i <= 9; ++i) {
    const double x = 0.95 + 0.001 * i;
    const double depth = at(x).touching.at(0).depth_m;
    if (std::abs(depth - before) > 1e-6) {
      ++refreshed;
      EXPECT_NEAR(depth, x - 0.9, 1e-9);
    }
    before = depth;
  }
  EXPECT_EQ(refreshed, 3);
}

TEST_F(CheckerTest, TellsEveryChangeOnce) {
  track();
  EXPECT_EQ(told(at(0.0)), "");
  EXPECT_EQ(told(at(0.86)), "entered_warning");
  EXPECT_EQ(told(at(0.87)), "");
  EXPECT_EQ(told(at(0.92)), "touched");
  EXPECT_EQ(told(at(0.93)), "");
  EXPECT_EQ(told(at(0.88)), "parted");
  EXPECT_EQ(told(at(0.89)), "");
  const ProximityState& last = at(0.5);
  ASSERT_EQ(told(last), "left_warning");
  EXPECT_EQ(last.events[0].sequence, 4U);
  EXPECT_NEAR(last.events[0].distance_m, 0.4, 1e-12);  // though beyond the warning distance
  EXPECT_EQ(last.events[0].posture_time, last.posture_time);
  EXPECT_EQ(std::min(last.events[0].a, last.events[0].b), "Sledge.X");
}

TEST_F(CheckerTest, TellsJumpsAsTheChangesThatTheyContain) {
  track();
  EXPECT_EQ(told(at(0.0)), "");
  EXPECT_EQ(told(at(1.5)), "entered_warning touched");
  EXPECT_EQ(told(at(0.0)), "parted left_warning");
}

TEST_F(CheckerTest, RepeatsNothingWhenTheCellChanges) {
  track();
  EXPECT_EQ(told(at(0.95)), "entered_warning touched");
  ASSERT_TRUE(cell->set_placement("Wall", Pose(Eigen::Translation3d(1.5, 0.1, 0.0))));
  adopt();
  EXPECT_EQ(told(at(0.95)), "");
  EXPECT_EQ(told(at(0.0)), "parted left_warning");
}

TEST_F(CheckerTest, ForgetsAPairThatIsNoLongerTested) {
  track();
  at(0.95);
  settings.rules = {{"Sledge", "Wall", PairRule::Kind::ignore, ""}};
  adopt();
  EXPECT_EQ(told(at(0.95)), "");
  EXPECT_TRUE(check().touching.empty());
  settings.rules.clear();
  adopt();
  EXPECT_EQ(told(at(0.95)), "entered_warning touched");
}

TEST_F(CheckerTest, TakesANewWarningDistance) {
  track();
  EXPECT_EQ(told(at(0.5)), "");
  settings.warning_distance_m = 0.6;
  adopt();
  EXPECT_EQ(told(check()), "entered_warning");
  EXPECT_TRUE(check().near.at(0).within_warning);
}

TEST_F(CheckerTest, FindsNothingWhileInactive) {
  track();
  settings.active = false;
  adopt();
  EXPECT_TRUE(at(0.95).near.empty());
  settings.active = true;
  adopt();
  EXPECT_EQ(told(at(0.95)), "entered_warning touched");
}

TEST_F(CheckerTest, TellsTheTimeToContact) {
  track();
  CellPoses later;
  joint("SLEDGE", 0) = 0.402;
  compute_poses(*compiled, q, later);
  joint("SLEDGE", 0) = 0.4;
  compute_poses(*compiled, q, poses);
  const NearPair approaching = sut.check(poses, Timestamp{1}, &later, std::chrono::milliseconds(4)).near.at(0);
  EXPECT_NEAR(approaching.closing_speed_m_s.value_or(0), 0.5, 1e-9);
  EXPECT_NEAR(approaching.time_to_contact_s.value_or(0), 1.0, 1e-9);
  const NearPair parting = sut.check(later, Timestamp{2}, &poses, std::chrono::milliseconds(4)).near.at(0);
  EXPECT_NEAR(parting.closing_speed_m_s.value_or(0), -0.5, 1e-9);
  EXPECT_FALSE(parting.time_to_contact_s);
  const NearPair standing = sut.check(poses, Timestamp{3}, &poses, std::chrono::milliseconds(4)).near.at(0);
  EXPECT_FALSE(standing.closing_speed_m_s);
}

TEST_F(CheckerTest, DoubtsAPlaceThatIsNotANumber) {
  track();
  at(0.0);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200}) {
    const ProximityState& findings = at(bad);
    ASSERT_EQ(findings.touching.size(), 1U) << bad;
    EXPECT_TRUE(findings.touching[0].doubtful);
    ASSERT_EQ(findings.near.size(), 1U);
    EXPECT_TRUE(findings.nearest()->doubtful);
    EXPECT_EQ(findings.nearest()->distance_m, 0.0);
    ASSERT_EQ(findings.doubts.size(), 1U);
    EXPECT_EQ(findings.doubts[0], "Sledge.X: its pose is unknown; treated as touching");
    EXPECT_TRUE(sut.collides(poses));
  }
  const ProximityState& again = at(0.0);
  EXPECT_NEAR(again.nearest()->distance_m, 0.9, 1e-12);
  EXPECT_TRUE(again.doubts.empty());
}

TEST_F(CheckerTest, PassesTheDoubtsOfTheTableOn) {
  build(std::string(kTrack) + "[[node]]\nname = \"Thing\"\ngeometry = [{ name = \"casting\", mesh = \"c.stl\" }]\n");
  adopt();
  EXPECT_EQ(at(0.0).doubts.size(), 1U);
  EXPECT_EQ(at(0.0).doubts.size(), 1U);
}

TEST_F(CheckerTest, AsksForASecondOpinionWhenATouchBeginsAndEnds) {
  track();
  at(0.0);
  const auto before = sut.counters().second_opinions;
  at(0.95);
  EXPECT_GT(sut.counters().second_opinions, before);
  at(0.5);
  EXPECT_EQ(sut.counters().disagreements, 0U);
  EXPECT_EQ(sut.counters().doubts, 0U);
}

TEST_F(CheckerTest, AnswersAtOnceWhetherAnythingCollides) {
  track();
  for (const double x : {0.0, 0.95, 0.5, 3.0, 1.9, -1.0}) {
    joint("SLEDGE", 0) = x;
    compute_poses(*compiled, q, poses);
    EXPECT_EQ(sut.collides(poses), x > 0.9 && x < 2.1) << x;
  }
}

TEST_F(CheckerTest, DoesNotMixUpPosturesOfCollidesAndCheck) {
  track();
  at(0.0);
  joint("SLEDGE", 0) = 0.95;
  compute_poses(*compiled, q, poses);
  EXPECT_TRUE(sut.collides(poses));
  const ProximityState& findings = at(0.001);
  EXPECT_EQ(told(findings), "");
  EXPECT_NEAR(findings.nearest()->distance_m, 0.899, 1e-12);
}

}  // namespace
}  // namespace cellmirror::collision
