// An hour of the transfer cell, every robot moving: 9,000 postures, 0.4 s from one to the next. No exception, nothing
// that is not finite, events that follow from each other; and in sampled postures every pair beside independent
// implementations: FCL for touches of whatever shape, brute force over all triangles for distances of meshes.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <optional>
#include <set>

#include "rt_core/collision/bounds.hpp"
#include "rt_core/collision/checker.hpp"
#include "rt_core/collision/second_opinion.hpp"
#include "tests/stress/collision/moving_cell.hpp"
#include "tests/support/geometry_oracle/brute_force.hpp"

namespace cellmirror::collision {
namespace {

constexpr int kPostures = 9'000;
constexpr double kApart_s = 0.4;
constexpr int kSeenByFcl = 25;  // one of so many postures
constexpr int kSeenByOracle = 750;
constexpr double kOracleReach = 0.06;  // m; beyond the warning distance

using BodyPair = std::pair<std::uint32_t, std::uint32_t>;

// Zone of a pair as its events tell it: 0 far, 1 within the warning distance, 2 touching.
class EventLog {
 public:
  void take(const ProximityEvent& event) {
    EXPECT_EQ(event.sequence, ++last_);
    EXPECT_TRUE(std::isfinite(event.distance_m));
    int& zone = zones_[{event.a, event.b}];
    constexpr std::array kFrom{0, 1, 2, 1};
    constexpr std::array kTo{1, 2, 1, 0};
    const auto change = static_cast<std::size_t>(event.change);
    EXPECT_EQ(zone, kFrom[change]) << event.a << ' ' << event.b;
    zone = kTo[change];
  }
  std::size_t count(int zone) const {
    return static_cast<std::size_t>(std::ranges::count_if(zones_, [&](const auto& z) { return z.second == zone; }));
  }

 private:
  std::uint64_t last_ = 0;
  std::map<std::pair<std::string, std::string>, int> zones_;
};

struct HourTest : testing::Test {
  void SetUp() override {
    table = derivation.derive(*cell.compiled(), settings);
    sut.adopt(cell.compiled(), table, settings);
    sut.limit_contacts(1);  // depths of deep overlaps are most of the time
  }

  const Pose& pose(const Body& body, const CellPoses& poses) const {
    return poses.X_WN[static_cast<std::size_t>(body.node)];
  }
  std::string names(const Pair& pair) const { return (*table->names)[pair.a] + " - " + (*table->names)[pair.b]; }

  void expect_sound(const ProximityState& findings, EventLog& log) {
    ASSERT_FALSE(findings.near.empty());
    std::size_t within = 0;
    std::size_t at_zero = 0;
    for (const NearPair& near : findings.near) {
      EXPECT_TRUE(std::isfinite(near.distance_m) && near.distance_m >= 0.0);
      EXPECT_TRUE(near.point_a_m.allFinite() && near.point_b_m.allFinite());
      within += near.within_warning ? 1U : 0U;
      at_zero += near.distance_m == 0.0 ? 1U : 0U;
    }
    for (const TouchingPair& touching : findings.touching) {
      EXPECT_TRUE(std::isfinite(touching.depth_m) && touching.depth_m >= 0.0);
      EXPECT_TRUE(touching.point_m.allFinite() && touching.normal.allFinite());
      EXPECT_LE(touching.points.size(), 8U);
    }
    for (const ProximityEvent& event : findings.events) log.take(event);
    EXPECT_EQ(at_zero, findings.touching.size());
    EXPECT_EQ(log.count(2), findings.touching.size());
    EXPECT_EQ(log.count(1) + log.count(2), within);
  }

  static std::map<BodyPair, double> told(const ProximityState& findings) {
    std::map<BodyPair, double> distances;
    for (const NearPair& near : findings.near) distances[{near.a, near.b}] = near.distance_m;
    return distances;
  }

  void compare_with_fcl(const ProximityState& findings, const CellPoses& poses) {
    const auto distances = told(findings);
    std::map<BodyPair, double> depths;
    for (const TouchingPair& touching : findings.touching) depths[{touching.a, touching.b}] = touching.depth_m;
    for (const Pair& pair : table->pairs) {
      if (!is_tested(pair.state)) continue;
      const auto depth = depths.find({pair.a, pair.b});
      const auto distance = distances.find({pair.a, pair.b});
      OwnVerdict own;
      own.touching = depth != depths.end();
      own.depth = own.touching ? depth->second : 0.0;
      own.distance = distance != distances.end() ? distance->second : settings.warning_distance_m;
      const Body& a = table->bodies[pair.a];
      const Body& b = table->bodies[pair.b];
      EXPECT_EQ(fcl.ask(a, pose(a, poses), b, pose(b, poses), own), Opinion::agrees)
          << names(pair) << " touching: " << own.touching << ", distance " << own.distance << ", depth " << own.depth;
    }
  }

  // Those that may be nearer than kOracleReach to any of the others.
  static std::vector<geometry_oracle::Corners> near_to(const std::vector<geometry_oracle::Corners>& triangles,
                                                       const std::vector<geometry_oracle::Corners>& others) {
    using geometry_oracle::Real;
    geometry_oracle::Point lower = others[0][0];
    geometry_oracle::Point upper = lower;
    for (const auto& triangle : others) {
      for (const auto& corner : triangle) {
        for (std::size_t k = 0; k < 3; ++k) {
          lower[k] = std::min(lower[k], corner[k]);
          upper[k] = std::max(upper[k], corner[k]);
        }
      }
    }
    std::vector<geometry_oracle::Corners> near;
    for (const auto& triangle : triangles) {
      bool far = false;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [least, most] = std::minmax({triangle[0][k], triangle[1][k], triangle[2][k]});
        far = far || least - upper[k] > Real{kOracleReach} || lower[k] - most > Real{kOracleReach};
      }
      if (!far) near.push_back(triangle);
    }
    return near;
  }

  // Brute force, infinite beyond kOracleReach; none where a part is no mesh or the boxes are far apart.
  std::optional<double> oracle_distance(const Body& a, const Body& b, const CellPoses& poses) const {
    double least = std::numeric_limits<double>::infinity();
    for (const BodyPart& part_a : a.parts) {
      for (const BodyPart& part_b : b.parts) {
        if (!part_a.solid->tree || !part_b.solid->tree) return std::nullopt;
        const auto& mesh_a = part_a.solid->tree->mesh();
        const auto& mesh_b = part_b.solid->tree->mesh();
        const auto triangles_a = geometry_oracle::placed(mesh_a, pose(a, poses) * part_a.X_NG);
        const auto triangles_b = geometry_oracle::placed(mesh_b, pose(b, poses) * part_b.X_NG);
        auto found = static_cast<double>(
            geometry_oracle::surface_distance(near_to(triangles_a, triangles_b), near_to(triangles_b, triangles_a))
                .distance);
        // Where surfaces are apart, one corner decides for all whether a connected body lies inside.
        if (mesh_a.closed && geometry_oracle::winding_number(triangles_a, triangles_b[0][0]) > 0.5L) found = 0;
        if (mesh_b.closed && geometry_oracle::winding_number(triangles_b, triangles_a[0][0]) > 0.5L) found = 0;
        least = std::min(least, found);
      }
    }
    return least;
  }

  void compare_with_oracle(const ProximityState& findings, const CellPoses& poses) {
    const auto distances = told(findings);
    for (const Pair& pair : table->pairs) {
      if (!is_tested(pair.state)) continue;
      const Body& a = table->bodies[pair.a];
      const Body& b = table->bodies[pair.b];
      const Eigen::Vector3d p_a = pose(a, poses) * box_around(a).X_NB.translation();
      const Eigen::Vector3d p_b = pose(b, poses) * box_around(b).X_NB.translation();
      if ((p_b - p_a).norm() - ball_around(a).radius - ball_around(b).radius > kOracleReach) continue;
      const auto expected = oracle_distance(a, b, poses);
      if (!expected) continue;
      ++oracle_pairs;
      const auto known = distances.find({pair.a, pair.b});
      if (known != distances.end()) {
        EXPECT_NEAR(known->second, *expected, 1e-9) << names(pair);
      } else {
        EXPECT_GT(*expected, settings.warning_distance_m) << names(pair);
      }
    }
  }

  Settings settings;
  MovingCell cell{transfer_cell_file(), 7, 0.7};
  PairDerivation derivation{std::make_shared<geometry::SolidLibrary>()};
  std::shared_ptr<const PairTable> table;
  Checker sut;
  SecondOpinion fcl;
  std::size_t oracle_pairs = 0;
};

TEST_F(HourTest, MissesNothingInAnHour) {
  EventLog log;
  std::size_t touching = 0;
  for (int i = 0; i < kPostures && !HasFailure(); ++i) {
    const CellPoses& poses = cell.at(kApart_s * i);
    const ProximityState& findings = sut.check(poses, Timestamp{i + 1});
    expect_sound(findings, log);
    if (!findings.touching.empty()) ++touching;
    if (i % kSeenByFcl == 0) compare_with_fcl(findings, poses);
    if (i % kSeenByOracle == 0) compare_with_oracle(findings, poses);
    if (HasFailure()) ADD_FAILURE() << "posture " << i;
  }
  EXPECT_GT(touching, 0U) << "nothing to see: the paths never meet";
  EXPECT_GT(oracle_pairs, 0U);
  EXPECT_EQ(sut.counters().disagreements, 0U);
  EXPECT_EQ(sut.counters().doubts, 0U);
  RecordProperty("touching", static_cast<int>(touching));
  RecordProperty("oracle_pairs", static_cast<int>(oracle_pairs));
  std::cout << touching << " of " << kPostures << " postures with a touch; " << oracle_pairs
            << " pairs of meshes compared with brute force, " << sut.counters().second_opinions << " second opinions\n";
}

}  // namespace
}  // namespace cellmirror::collision
