// How deep convex shapes overlap: closed forms, and for every pair of kinds that the way parts them and no shorter one
// does.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/unit/geometry_convex/shapes.hpp"

namespace cellmirror::geometry {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kExact = 1e-9;  // m

void expect(const Penetration& answer, double depth, const Vector3d& normal) {
  EXPECT_NEAR(answer.depth, depth, kExact);
  EXPECT_LT((answer.normal - normal).norm(), 1e-6) << answer.normal.transpose();
}

TEST(ConvexPenetration, knowsSpheresAndCapsules) {
  const Penetration spheres = convex_penetration(sphere(0.5), at(0, 0, 0), sphere(0.5), at(0.75, 0, 0));
  expect(spheres, 0.25, Vector3d::UnitX());
  EXPECT_LT((spheres.point - Vector3d(0.375, 0, 0)).norm(), kExact);
  expect(convex_penetration(capsule(0.5, 2), at(0, 0, 0), sphere(0.25), at(0, 0.5, 1)), 0.25, Vector3d::UnitY());
  EXPECT_NEAR(convex_penetration(sphere(0.5), at(1, 2, 3), sphere(0.25), at(1, 2, 3)).depth, 0.75, kExact);
  EXPECT_EQ(convex_penetration(sphere(0.5), at(0, 0, 0), sphere(0.5), at(2, 0, 0)).depth, 0.0);
}

TEST(ConvexPenetration, knowsBoxes) {
  const Penetration faces = convex_penetration(box(1, 1, 1), at(0, 0, 0), box(1, 1, 1), at(0.1, -0.2, 1.5));
  expect(faces, 0.5, Vector3d::UnitZ());
  EXPECT_NEAR(faces.point.z(), 0.75, kExact);
  expect(convex_penetration(box(1, 2, 3), at(0, 0, 0), sphere(0.25), at(0.9, 0, 0)), 0.35, Vector3d::UnitX());
  expect(convex_penetration(box(1, 1, 1), turned(at(0, 0, 0), pi / 4, Vector3d::UnitX()), box(1, 1, 1),
                            turned(at(0, 0, 2.5), pi / 4, Vector3d::UnitY())),
         2 * std::sqrt(2.0) - 2.5, Vector3d::UnitZ());
  const Penetration nested = convex_penetration(box(1, 1, 1), at(0, 0, 0), box(0.1, 0.1, 0.1), at(0, 0.5, 0));
  expect(nested, 0.6, Vector3d::UnitY());
}

TEST(ConvexPenetration, knowsCylinders) {
  const ConvexCore sut = cylinder(0.5, 1);
  expect(convex_penetration(sut, at(0, 0, 0), cylinder(0.5, 1), at(0.8, 0, 0.1)), 0.2, Vector3d::UnitX());
  expect(convex_penetration(sut, at(0, 0, 0), cylinder(0.5, 1), at(0.1, 0, 1.9)), 0.1, Vector3d::UnitZ());
  expect(convex_penetration(box(5, 5, 1), at(0, 0, 0), sut, at(1, 1, 1.8)), 0.2, Vector3d::UnitZ());
  expect(convex_penetration(box(5, 5, 1), at(0, 0, 0), sut, turned(at(1, 1, 1.3), pi / 2, Vector3d::UnitX())), 0.2,
         Vector3d::UnitZ());
  // Rims that cross, in planes square to each other: thin discs, so that no other way is shorter.
  const Penetration rims = convex_penetration(cylinder(1, 0.4), at(0, 0, 0), cylinder(1, 0.4),
                                              turned(at(1.99, 0, 0), pi / 2, Vector3d::UnitX()));
  expect(rims, 0.01, Vector3d::UnitX());
  // On the axis every way across is as short.
  EXPECT_NEAR(convex_penetration(sut, at(0, 0, 0), sphere(0.25), at(0, 0, 0)).depth, 0.75, kExact);
}

TEST(ConvexPenetration, isNothingBetweenSurfacesThatTouch) {
  const ConvexCore face = triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  EXPECT_NEAR(convex_penetration(face, at(0, 0, 0), face, at(0, 0, 0)).depth, 0.0, kExact);
  EXPECT_NEAR(convex_penetration(face, at(0, 0, 0), capsule(0.1, 0), at(0, 0, 0)).depth, 0.1, kExact);
  expect(convex_penetration(face, at(0, 0, 0), box(0.2, 0.2, 0.2), at(0, 0, 0.1)), 0.1, Vector3d::UnitZ());
}

struct PairOfKinds {
  CoreKind a;
  CoreKind b;
};
class EveryOverlap : public ::testing::TestWithParam<PairOfKinds> {
 protected:
  // Overlapping shapes at random, as many as were found in so many tries.
  template <typename Check>
  int for_each_overlap(std::uint64_t seed, int tries, const Check& check) {
    AnyShapes any(seed);
    int found = 0;
    for (int i = 0; i < tries && !HasFatalFailure(); ++i) {
      const ConvexCore a = any.core(GetParam().a);
      const ConvexCore b = any.core(GetParam().b);
      const Pose X_WA = i % 4 == 0 ? any.flush_pose() : any.pose(0.25);
      const Pose X_WB = i % 4 == 0 ? any.flush_pose() : any.pose(0.25);
      if (convex_distance(a, X_WA, b, X_WB).points.distance > 0.0) continue;
      ++found;
      check(a, X_WA, b, X_WB, any);
    }
    return found;
  }
};

Pose shifted(Pose X, const Vector3d& by) {
  X.translation() += by;
  return X;
}

TEST_P(EveryOverlap, partsThemJust) {
  const int found =
      for_each_overlap(11, 400, [](const auto& a, const auto& X_WA, const auto& b, const auto& X_WB, auto&) {
        const Penetration sut = convex_penetration(a, X_WA, b, X_WB);
        ASSERT_NEAR(sut.normal.norm(), 1.0, 1e-12);
        ASSERT_GE(sut.depth, 0.0);
        const double hair = 1e-6;
        const Pose X_parted = shifted(X_WB, (sut.depth + hair) * sut.normal);
        ASSERT_NEAR(convex_distance(a, X_WA, b, X_parted).points.distance, hair, kExact);
        if (sut.depth < hair) return;
        // Zero but for rounding, which differs between compilers where a line just pierces a round wall.
        ASSERT_LE(convex_distance(a, X_WA, b, shifted(X_WB, 0.99 * sut.depth * sut.normal)).points.distance, 1e-15);
        // The other way round they are as deep, and parted by moving a.
        ASSERT_NEAR(convex_penetration(b, X_WB, a, X_WA).depth, sut.depth, 1e-7);
      });
  // Points and segments without skin hardly ever meet.
  EXPECT_GT(found, 0);
}

TEST_P(EveryOverlap, isTheShortestWayOfAll) {
  for_each_overlap(12, 120, [](const auto& a, const auto& X_WA, const auto& b, const auto& X_WB, auto& any) {
    const Penetration sut = convex_penetration(a, X_WA, b, X_WB);
    for (int i = 0; i < 60; ++i) {
      const Vector3d way = i < 30 ? any.direction() : (sut.normal + 0.05 * any.direction()).normalized();
      const double overlap = reach(a, X_WA, way) + reach(b, X_WB, -way);
      ASSERT_GE(overlap, sut.depth - kExact) << way.transpose();
    }
  });
}

TEST_P(EveryOverlap, isTheSameWhereverItIsLookedAtFrom) {
  for_each_overlap(13, 100, [](const auto& a, const auto& X_WA, const auto& b, const auto& X_WB, auto& any) {
    const Pose X_VW = any.pose(3.0);
    const double depth = convex_penetration(a, X_WA, b, X_WB).depth;
    ASSERT_NEAR(convex_penetration(a, X_VW * X_WA, b, X_VW * X_WB).depth, depth, 1e-7);
    const Vector3d far(1e5, 1e5, -1e5);
    ASSERT_NEAR(convex_penetration(a, shifted(X_WA, far), b, shifted(X_WB, far)).depth, depth, 1e-7);
  });
}

std::vector<PairOfKinds> all_pairs() {
  std::vector<PairOfKinds> out;
  for (const CoreKind a : kAllKinds) {
    for (const CoreKind b : kAllKinds) {
      if (a <= b) out.push_back({a, b});
    }
  }
  return out;
}
INSTANTIATE_TEST_SUITE_P(Convex, EveryOverlap, ::testing::ValuesIn(all_pairs()),
                         [](const auto& test) { return name(test.param.a) + "_" + name(test.param.b); });

}  // namespace
}  // namespace cellmirror::geometry
