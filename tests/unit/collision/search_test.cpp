// The answers with memory are those of computing every pair anew, however the cell moves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "rt_core/geometry/proximity.hpp"
#include "tests/unit/collision/cell_of_bodies.hpp"

namespace cellmirror::collision {
namespace {

struct SearchTest : CellOfBodies {
  void SetUp() override {
    files->add("rack.mpc", R"(
geometry = [
  { name = "post 1", box_m = [0.1, 0.1, 2.0], xyz_m = [-0.5, 0.0, 1.0] },
  { name = "post 2", box_m = [0.1, 0.1, 2.0], xyz_m = [0.5, 0.0, 1.0] },
  { name = "shelf", box_m = [1.2, 0.4, 0.05], xyz_m = [0.0, 0.0, 1.2] },
  { name = "drum", cylinder_m = [0.2, 0.5], xyz_m = [0.0, 0.0, 0.3] },
]
)");
    build(R"(
[[node]]
name = "Hall"
geometry = [{ name = "floor", box_m = [6.0, 6.0, 0.1], xyz_m = [0.0, 0.0, -0.05] }]
[[node]]
name = "Rack"
xyz_m = [0.6, 0.9, 0.0]
rpy_rad = [0.0, 0.0, 0.4]
abstract = "rack.mpc"
[[node]]
name = "Sledge"
xyz_m = [0.0, -0.4, 0.0]
abstract = "sledge.mpc"
[[node]]
name = "A"
abstract = "arm.mpc"
robot_id = "A"
[[node]]
name = "B"
abstract = "arm.mpc"
robot_id = "B"
xyz_m = [1.2, 0.2, 0.0]
)",
          {{"A", "Sledge.X"}});
    adopt();
  }

  struct Naive {
    std::vector<NearPair> within;
    NearPair nearest;
    bool touching = false;
  };
  Naive naive(double warning) const {
    Naive result;
    result.nearest.distance_m = 1e300;
    for (const Pair& one : table->pairs) {
      if (!is_tested(one.state)) continue;
      const double distance = distance_of(table->bodies[one.a], table->bodies[one.b]);
      NearPair near;
      near.a = one.a;
      near.b = one.b;
      near.distance_m = distance <= geometry::kTouchDistance ? 0.0 : distance;
      if (near.distance_m <= warning) result.within.push_back(near);
      if (near.distance_m < result.nearest.distance_m) result.nearest = near;
      if (near.distance_m == 0.0) result.touching = true;
    }
    std::ranges::sort(result.within, {}, &NearPair::distance_m);
    return result;
  }
  double distance_of(const Body& a, const Body& b) const {
    double least = 1e300;
    for (const BodyPart& part_a : a.parts) {
      for (const BodyPart& part_b : b.parts) {
        geometry::ProximityHint hint;
        const auto found = geometry::separation(
            *part_a.solid, poses.X_WN[static_cast<std::size_t>(a.node)] * part_a.X_NG, *part_b.solid,
            poses.X_WN[static_cast<std::size_t>(b.node)] * part_b.X_NG, 1e300, hint);
        least = std::min(least, found.points.distance);
      }
    }
    return least;
  }

  void expect_naive(const ProximityState& findings) {
    const Naive expected = naive(settings.warning_distance_m);
    ASSERT_FALSE(findings.near.empty());
    EXPECT_NEAR(findings.nearest()->distance_m, expected.nearest.distance_m, 1e-12);
    std::size_t within = 0;
    for (const NearPair& near : findings.near) {
      if (near.distance_m > settings.warning_distance_m) {
        // The nearest of all, or one that has not left yet.
        EXPECT_TRUE(&near == findings.nearest() || near.within_warning);
        EXPECT_TRUE(!near.within_warning || near.distance_m <= settings.warning_distance_m + 0.5e-3);
        continue;
      }
      ASSERT_LT(within, expected.within.size());
      EXPECT_NEAR(near.distance_m, expected.within[within].distance_m, 1e-12);
      EXPECT_TRUE(near.within_warning);
      ++within;
    }
    EXPECT_EQ(within, expected.within.size());
    EXPECT_EQ(sut.collides(poses), expected.touching);
    EXPECT_EQ(findings.touching.empty(), !expected.touching);
  }

  void set_smooth(double t) {
    for (const char* robot : {"A", "B"}) {
      for (std::size_t i = 0; i < 4; ++i)
        joint(robot, i) = 1.4 * std::sin((0.7 + 0.31 * static_cast<double>(i) + (robot[0] == 'B' ? 0.2 : 0.0)) * t);
    }
    joint("SLEDGE", 0) = 0.8 * std::sin(0.4 * t);
  }
};

TEST_F(SearchTest, AgreesAlongPaths) {
  for (int i = 0; i < 3000; ++i) {
    set_smooth(0.005 * i);
    const ProximityState& findings = check();
    ASSERT_NO_FATAL_FAILURE(expect_naive(findings)) << i;
    if (HasFailure()) FAIL() << "frame " << i;
  }
  EXPECT_EQ(sut.counters().doubts, 0U);
  EXPECT_EQ(sut.counters().disagreements, 0U);
}

TEST_F(SearchTest, AgreesWhenEverythingJumps) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(-2.0, 2.0);
  for (int i = 0; i < 1000; ++i) {
    for (auto& values : q) std::ranges::generate(values, [&] { return angle(random); });
    const ProximityState& findings = check();
    ASSERT_NO_FATAL_FAILURE(expect_naive(findings)) << i;
    if (HasFailure()) FAIL() << "frame " << i;
  }
  EXPECT_EQ(sut.counters().doubts, 0U);
}

TEST_F(SearchTest, AgreesWithAWideWarningDistance) {
  settings.warning_distance_m = 0.5;
  adopt();
  for (int i = 0; i < 500; ++i) {
    set_smooth(0.02 * i);
    const ProximityState& findings = check();
    ASSERT_NO_FATAL_FAILURE(expect_naive(findings)) << i;
  }
}

TEST_F(SearchTest, StandsStillForNothing) {
  set_smooth(0.3);
  check();
  const auto before = sut.counters().pairs_computed;
  const double distance = check().nearest()->distance_m;
  for (int i = 0; i < 10; ++i) EXPECT_EQ(check().nearest()->distance_m, distance);
  EXPECT_EQ(sut.counters().pairs_computed, before);
}

// In equal arms that stand alike, the nearest pairs of each are equally near but for rounding.
TEST_F(SearchTest, StandsStillForNothingWhereEqualArmsStandAlike) {
  build(R"(
[[node]]
name = "A"
abstract = "arm.mpc"
robot_id = "A"
xyz_m = [0.3, 0.0, 0.0]
[[node]]
name = "B"
abstract = "arm.mpc"
robot_id = "B"
xyz_m = [5.1, 0.0, 0.0]
[[node]]
name = "C"
abstract = "arm.mpc"
robot_id = "C"
xyz_m = [9.7, 0.0, 0.0]
)");
  adopt();
  for (const char* arm : {"A", "B", "C"}) {
    for (std::size_t i = 0; i < 4; ++i) joint(arm, i) = 0.3;
  }
  check();
  check();  // the limit of this one is the distance that the first one found
  const auto before = sut.counters().pairs_computed;
  for (int i = 0; i < 10; ++i) ASSERT_NO_FATAL_FAILURE(expect_naive(check()));
  EXPECT_EQ(sut.counters().pairs_computed, before);
}

TEST_F(SearchTest, ComputesFewPairsAFrame) {
  set_smooth(0.0);
  check();
  const auto before = sut.counters().pairs_computed;
  for (int i = 1; i <= 1000; ++i) {
    set_smooth(0.001 * i);
    check();
  }
  const double a_frame = static_cast<double>(sut.counters().pairs_computed - before) / 1000.0;
  EXPECT_LT(a_frame, 0.3 * static_cast<double>(sut.check(poses, Timestamp{1}).pairs));
}

}  // namespace
}  // namespace cellmirror::collision
