// Distances of convex shapes: closed forms, and proofs of every answer in poses of all kinds.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/unit/geometry_convex/shapes.hpp"

namespace cellmirror::geometry {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kClosed = 1e-12;  // m, where a closed form answers
constexpr double kExact = 1e-9;    // m, else

double distance(const ConvexCore& a, const Pose& X_WA, const ConvexCore& b, const Pose& X_WB) {
  const ConvexDistance answer = convex_distance(a, X_WA, b, X_WB);
  EXPECT_TRUE(answer.certain);
  return answer.points.distance;
}

TEST(ConvexDistance, knowsSpheresAndCapsules) {
  EXPECT_NEAR(distance(sphere(0.5), at(0, 0, 0), sphere(0.25), at(3, 4, 0)), 4.25, kClosed);
  EXPECT_NEAR(distance(capsule(0.1, 1), at(0, 0, 0), capsule(0.2, 1), at(1, 0, 0.5)), 0.7, kClosed);
  EXPECT_NEAR(distance(capsule(0.1, 1), at(0, 0, 0), capsule(0.2, 1), at(0, 0, 3)), 0.7, kClosed);
  const Pose crossed = turned(at(0, 2, 0), pi / 2, Vector3d::UnitX());
  EXPECT_NEAR(distance(capsule(0.1, 1), turned(at(0, 0, 0), pi / 2, Vector3d::UnitY()), capsule(0.2, 0.5), crossed),
              1.2, kClosed);
  EXPECT_NEAR(distance(sphere(0.5), at(0, 3, 0.2), capsule(0.25, 1), at(0, 0, 0)), 2.25, kClosed);
}

TEST(ConvexDistance, knowsTheFeaturesOfABox) {
  const ConvexCore sut = box(1, 2, 3);
  EXPECT_NEAR(distance(sut, at(0, 0, 0), sphere(0.5), at(2, 0.5, 0.5)), 0.5, kClosed);
  EXPECT_NEAR(distance(sut, at(0, 0, 0), sphere(0.5), at(4, 6, 0)), 4.5, kClosed);
  EXPECT_NEAR(distance(sut, at(0, 0, 0), sphere(0.5), at(2, 4, 5)), 2.5, kClosed);
  EXPECT_NEAR(distance(sut, at(0, 0, 0), box(1, 1, 1), at(2.5, 0.3, 0.1)), 0.5, kClosed);
  // Edge to edge: two cubes turned by 45 degrees about axes that cross.
  EXPECT_NEAR(distance(box(1, 1, 1), turned(at(0, 0, 0), pi / 4, Vector3d::UnitX()), box(1, 1, 1),
                       turned(at(0, 0, 4), pi / 4, Vector3d::UnitY())),
              4 - 2 * std::sqrt(2.0), kClosed);
  EXPECT_NEAR(distance(sut, at(0, 0, 0), capsule(0.25, 0.5), at(2, 0, 5)), std::hypot(1, 1.5) - 0.25, kClosed);
}

TEST(ConvexDistance, knowsTheSidesCapsAndRimsOfCylinders) {
  const ConvexCore sut = cylinder(0.5, 1);
  const Pose origin = at(0, 0, 0);
  EXPECT_NEAR(distance(sut, origin, sphere(0.25), at(3, 4, 0.9)), 4.25, kClosed);
  EXPECT_NEAR(distance(sut, origin, sphere(0.25), at(0.3, 0.3, -2)), 0.75, kClosed);
  EXPECT_NEAR(distance(sut, origin, sphere(0.25), at(3.5, 0, 5)), 4.75, kClosed);
  EXPECT_NEAR(distance(sut, origin, cylinder(0.25, 2), at(0, 2, 0.5)), 1.25, kExact);   // parallel axes
  EXPECT_NEAR(distance(sut, origin, cylinder(0.25, 2), at(0.1, 0.2, 4)), 1.0, kExact);  // cap to cap
  EXPECT_NEAR(distance(sut, origin, cylinder(0.25, 2), turned(at(0, 2, 0), pi / 2, Vector3d::UnitY())), 1.25,
              kExact);  // crossed axes
  // Rims of thin discs in one plane, and in planes that are square to each other.
  EXPECT_NEAR(distance(cylinder(1, 1e-6), origin, cylinder(1, 1e-6), at(3, 0, 0)), 1.0, kExact);
  EXPECT_NEAR(distance(cylinder(1, 0), origin, cylinder(1, 0), turned(at(3, 0, 0), pi / 2, Vector3d::UnitX())), 1.0,
              kExact);
  EXPECT_NEAR(distance(cylinder(1, 0), origin, cylinder(1, 0), at(4, 0, 3)), std::hypot(2, 3), kExact);
  // Flat on a face, lying on it, and standing on it on its rim.
  const ConvexCore table = box(5, 5, 1);
  EXPECT_NEAR(distance(table, origin, sut, at(0.5, 0.4, 2.25)), 0.25, kExact);
  EXPECT_NEAR(distance(table, origin, sut, turned(at(0.5, 0.4, 2.25), pi / 2, Vector3d(1, 1, 0))), 0.75, kExact);
  EXPECT_NEAR(distance(table, origin, sut, turned(at(0.5, 0.4, 3.25), 0.3, Vector3d(1, 2, 0))),
              2.25 - std::cos(0.3) - 0.5 * std::sin(0.3), kExact);
}

// Above a plane any shape is as near as it reaches down; the plane is a wide box, or a wide triangle.
TEST(ConvexDistance, measuresTheHeightOverAPlane) {
  AnyShapes any(1);
  const ConvexCore slab = box(50, 50, 1);
  const ConvexCore face = triangle({-90, -60, 0}, {90, -60, 0}, {0, 120, 0});
  for (const CoreKind kind : kAllKinds) {
    for (int i = 0; i < 200; ++i) {
      const ConvexCore sut = any.core(kind);
      Pose X = any.pose(1.0);
      X.translation().z() += 1.0 - X.translation().z() + reach(sut, Pose(X.linear()), -Vector3d::UnitZ());
      EXPECT_NEAR(distance(sut, X, slab, at(0, 0, -1)), 1.0, kExact) << name(kind);
      EXPECT_NEAR(distance(face, at(0, 0, 0), sut, X), 1.0, kExact) << name(kind);
    }
  }
}

struct PairOfKinds {
  CoreKind a;
  CoreKind b;
};
class EveryPair : public ::testing::TestWithParam<PairOfKinds> {};

TEST_P(EveryPair, isProvedInAnyPose) {
  AnyShapes any(2);
  for (int i = 0; i < 1500; ++i) {
    const ConvexCore a = any.core(GetParam().a);
    const ConvexCore b = any.core(GetParam().b);
    const Pose X_WA = any.pose(0.6);
    const Pose X_WB = any.pose(0.6);
    const ConvexDistance answer = convex_distance(a, X_WA, b, X_WB);
    ASSERT_TRUE(proved(a, X_WA, b, X_WB, answer, kExact)) << i;
    // Symmetric.
    const ConvexDistance back = convex_distance(b, X_WB, a, X_WA);
    ASSERT_NEAR(back.points.distance, answer.points.distance, kExact);
    // The same wherever it is looked at from.
    const Pose X_VW = any.pose(2.0);
    const ConvexDistance moved = convex_distance(a, X_VW * X_WA, b, X_VW * X_WB);
    ASSERT_NEAR(moved.points.distance, answer.points.distance, kExact);
  }
}

TEST_P(EveryPair, isProvedWhereFacesAreFlushAndEdgesParallel) {
  AnyShapes any(3);
  for (int i = 0; i < 1500; ++i) {
    const ConvexCore a = any.core(GetParam().a);
    const ConvexCore b = any.core(GetParam().b);
    const Pose X_WA = any.flush_pose();
    const Pose X_WB = any.flush_pose();
    ASSERT_TRUE(proved(a, X_WA, b, X_WB, convex_distance(a, X_WA, b, X_WB), kExact)) << i;
  }
}

TEST_P(EveryPair, isZeroWhereTheyTouchAndGrowsFromThere) {
  AnyShapes any(4);
  for (int i = 0; i < 300; ++i) {
    const ConvexCore a = any.core(GetParam().a);
    const ConvexCore b = any.core(GetParam().b);
    const Pose X_WA = i % 2 == 0 ? any.pose(0.3) : any.flush_pose();
    Pose X_WB = i % 2 == 0 ? any.pose(0.3) : any.flush_pose();
    const Vector3d n = any.direction();
    // At first apart, then as near as nearest points tell, then by a hair farther.
    X_WB.translation() += 5.0 * n;
    const ClosestPoints apart = convex_distance(a, X_WA, b, X_WB).points;
    const Vector3d towards_b = (apart.p_b - apart.p_a).normalized();
    X_WB.translation() += apart.p_a - apart.p_b;
    ASSERT_LT(convex_distance(a, X_WA, b, X_WB).points.distance, kExact) << i;
    for (const double gap : {1e-8, 1e-6, 1e-4}) {
      Pose X_near = X_WB;
      X_near.translation() += gap * towards_b;
      const ConvexDistance answer = convex_distance(a, X_WA, b, X_near);
      ASSERT_TRUE(answer.certain) << i;
      ASSERT_NEAR(answer.points.distance, gap, kExact) << i;
    }
  }
}

TEST_P(EveryPair, isZeroWhereOneIsTheOtherOrHoldsIt) {
  AnyShapes any(5);
  for (int i = 0; i < 200; ++i) {
    ConvexCore a = any.core(GetParam().a);
    ConvexCore b = any.core(GetParam().b);
    const Pose X = any.pose(1.0);
    ASSERT_LE(distance(a, X, a, X), kExact);
    b.skin += 1.0;
    const ConvexDistance answer = convex_distance(a, X, b, X);
    ASSERT_EQ(answer.points.distance, 0.0);
    ASSERT_LE(outside(a, X, answer.points.p_a), a.kind == CoreKind::triangle ? 2.0 : kExact);
  }
}

TEST_P(EveryPair, holdsFarFromTheOriginAndAtAnySize) {
  AnyShapes any(6);
  for (const double scale : {1e-6, 1e-3, 1.0, 1e3}) {
    for (int i = 0; i < 200; ++i) {
      ConvexCore a = any.core(GetParam().a);
      ConvexCore b = any.core(GetParam().b);
      for (ConvexCore* core : {&a, &b}) {
        core->half *= scale;
        core->skin *= scale;
        for (Vector3d& corner : core->corners) corner *= scale;
      }
      Pose X_WA = any.pose(0.6 * scale);
      Pose X_WB = any.pose(0.6 * scale);
      const ConvexDistance answer = convex_distance(a, X_WA, b, X_WB);
      ASSERT_TRUE(proved(a, X_WA, b, X_WB, answer, std::min(kExact, 1e-9 * scale) + 1e-10 * scale)) << scale;
      const Vector3d far(1e5, -2e5, 3e5);
      X_WA.translation() += far;
      X_WB.translation() += far;
      ASSERT_NEAR(convex_distance(a, X_WA, b, X_WB).points.distance, answer.points.distance, kExact * (1 + scale));
    }
  }
}

TEST_P(EveryPair, holdsWhereOneIsAMillionTimesTheOther) {
  AnyShapes any(7);
  for (int i = 0; i < 300; ++i) {
    ConvexCore a = any.core(GetParam().a);
    ConvexCore b = any.core(GetParam().b);
    b.half *= 1e-6;
    b.skin *= 1e-6;
    for (Vector3d& corner : b.corners) corner *= 1e-6;
    a.half *= 10;
    const Pose X_WA = any.pose(0.1);
    const Pose X_WB = any.pose(2.0);
    ASSERT_TRUE(proved(a, X_WA, b, X_WB, convex_distance(a, X_WA, b, X_WB), kExact)) << i;
  }
}

TEST_P(EveryPair, holdsWhereABodyIsFlatOrThin) {
  AnyShapes any(8);
  for (int i = 0; i < 600; ++i) {
    ConvexCore a = any.core(GetParam().a);
    ConvexCore b = any.core(GetParam().b);
    const std::array<double, 4> thin{0.0, 1e-12, 1e-8, 1e-5};
    for (ConvexCore* core : {&a, &b}) {
      const double to = thin[static_cast<std::size_t>(i) % 4];
      if (core->kind == CoreKind::box) core->half[i % 3] = to;
      if (core->kind == CoreKind::box && i % 5 == 0) core->half[(i + 1) % 3] = to;
      if (core->kind == CoreKind::cylinder && i % 2 == 0) core->half.z() = to;
      if (core->kind == CoreKind::cylinder && i % 2 == 1) core->half.x() = core->half.y() = to;
      if (core->kind == CoreKind::segment) core->half.z() = to;
    }
    const Pose X_WA = i % 3 == 0 ? any.flush_pose() : any.pose(0.6);
    const Pose X_WB = i % 3 == 0 ? any.flush_pose() : any.pose(0.6);
    ASSERT_TRUE(proved(a, X_WA, b, X_WB, convex_distance(a, X_WA, b, X_WB), kExact)) << i;
  }
}

TEST_P(EveryPair, mayStopAtTheBoundThatWasAskedFor) {
  AnyShapes any(9);
  for (int i = 0; i < 500; ++i) {
    const ConvexCore a = any.core(GetParam().a);
    const ConvexCore b = any.core(GetParam().b);
    const Pose X_WA = any.pose(0.8);
    const Pose X_WB = any.pose(0.8);
    const double exact = convex_distance(a, X_WA, b, X_WB).points.distance;
    for (const double up_to : {0.0, 0.01, 0.2, 1.0}) {
      const double bounded = convex_distance(a, X_WA, b, X_WB, up_to).points.distance;
      if (exact < up_to) {
        ASSERT_NEAR(bounded, exact, kExact);
      } else {
        ASSERT_GE(bounded, up_to);
        ASSERT_LE(bounded, exact + kExact);
      }
    }
  }
}

TEST_P(EveryPair, countsInputThatIsNoNumberAsTouching) {
  AnyShapes any(10);
  for (const double odd : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const ConvexCore a = any.core(GetParam().a);
    const ConvexCore b = any.core(GetParam().b);
    Pose X = any.pose(1.0);
    X.translation().x() = odd;
    for (const ConvexDistance& answer :
         {convex_distance(a, X, b, at(0, 0, 0)), convex_distance(a, at(0, 0, 0), b, X)}) {
      EXPECT_FALSE(answer.certain);
      EXPECT_EQ(answer.points.distance, 0.0);
    }
    static_cast<void>(convex_penetration(a, X, b, at(0, 0, 0)));
    ConvexCore bad = b;
    bad.half.z() = odd;
    EXPECT_FALSE(convex_distance(a, at(0, 0, 0), bad, at(0, 0, 0)).certain);
  }
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
INSTANTIATE_TEST_SUITE_P(Convex, EveryPair, ::testing::ValuesIn(all_pairs()),
                         [](const auto& test) { return name(test.param.a) + "_" + name(test.param.b); });

}  // namespace
}  // namespace cellmirror::geometry
